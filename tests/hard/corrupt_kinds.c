/* corrupt_kinds.c: ways to damage the bytes of a file, each a pure function of a seed. */
#include "corrupt_kinds.h"

#include <ctype.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { HEAD = 512 };

uint64_t tc_random(uint64_t *state)
{
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

/* From lo up to but without hi; lo where there is nothing between. */
static size_t between(uint64_t *random, size_t lo, size_t hi)
{
    uint64_t r = tc_random(random);
    return hi > lo ? lo + (size_t)(r % (hi - lo)) : lo;
}

static size_t least(size_t a, size_t b)
{
    return a < b ? a : b;
}

static size_t head_of(const tc_bytes *b)
{
    return least(b->n, HEAD);
}

/* Is the file text around this place? */
static bool text_at(const tc_bytes *b, size_t at)
{
    size_t end = least(b->n, at + 64);
    for (size_t i = at; i < end; i++)
        if (b->data[i] < 9 || (b->data[i] > 13 && b->data[i] < 32) || b->data[i] > 126)
            return false;
    return at < end;
}

/* Replaces `length` bytes at `at` by text. */
static void replace(tc_bytes *b, size_t at, size_t length, const void *text, size_t n)
{
    unsigned char *out = malloc(b->n - length + n + 1);
    if (!out)
        abort();
    memcpy(out, b->data, at);
    memcpy(out + at, text, n);
    memcpy(out + at + n, b->data + at + length, b->n - at - length);
    free(b->data);
    b->data = out;
    b->n = b->n - length + n;
}

static void fill(tc_bytes *b, size_t at, size_t n, unsigned char value)
{
    if (at < b->n)
        memset(b->data + at, value, least(n, b->n - at));
}

/* ------------------------------------------------------------------------------------------------------ cut short */

static void cut_all(tc_bytes *b, uint64_t *random, const tc_bytes *other)
{
    (void)random, (void)other;
    b->n = 0;
}

static void cut_head(tc_bytes *b, uint64_t *random, const tc_bytes *other)
{
    (void)other;
    b->n = between(random, least(1, b->n), least(64, b->n));
}

static void cut_early(tc_bytes *b, uint64_t *random, const tc_bytes *other)
{
    (void)other;
    b->n = between(random, b->n / 16, b->n / 4);
}

static void cut_middle(tc_bytes *b, uint64_t *random, const tc_bytes *other)
{
    (void)other;
    b->n = between(random, b->n / 4, b->n - b->n / 4);
}

static void cut_late(tc_bytes *b, uint64_t *random, const tc_bytes *other)
{
    (void)other;
    b->n = between(random, b->n - b->n / 10, b->n - b->n / 100);
}

static void cut_last(tc_bytes *b, uint64_t *random, const tc_bytes *other)
{
    (void)other;
    b->n -= least(b->n, between(random, 1, 17));
}

/* -------------------------------------------------------------------------------------------------- zeroed, flipped */

static void zero_head(tc_bytes *b, uint64_t *random, const tc_bytes *other)
{
    (void)other;
    fill(b, between(random, 0, head_of(b)), between(random, 8, 65), 0);
}

static void zero_body(tc_bytes *b, uint64_t *random, const tc_bytes *other)
{
    (void)other;
    fill(b, between(random, head_of(b), b->n), between(random, 64, b->n / 8 + 65), 0);
}

static void zero_tail(tc_bytes *b, uint64_t *random, const tc_bytes *other)
{
    (void)random, (void)other;
    fill(b, b->n - b->n / 3, b->n, 0);
}

static void flip(tc_bytes *b, uint64_t *random, size_t from, size_t to, size_t count)
{
    for (size_t i = 0; i < count && from < to; i++) {
        size_t at = between(random, from, to);
        b->data[at] ^= (unsigned char)(1u << (tc_random(random) & 7));
    }
}

static void flip_head(tc_bytes *b, uint64_t *random, const tc_bytes *other)
{
    (void)other;
    flip(b, random, 0, head_of(b), 8);
}

static void flip_body(tc_bytes *b, uint64_t *random, const tc_bytes *other)
{
    (void)other;
    flip(b, random, head_of(b) / 2, b->n, 8 + b->n / 4096);
}

static void flip_one(tc_bytes *b, uint64_t *random, const tc_bytes *other)
{
    (void)other;
    flip(b, random, 0, b->n, 1);
}

/* --------------------------------------------------------------------------------------------------- wrong numbers */

/* The first number of a text at or behind `at`, before `end`: its length, place in *found; 0: there is none. */
static size_t find_number(size_t *found, const tc_bytes *b, size_t at, size_t end)
{
    for (; at < end; at++)
        if (isdigit(b->data[at]) && (at == 0 || (!isalnum(b->data[at - 1]) && b->data[at - 1] != '.'))) {
            size_t n = 1;
            while (at + n < b->n && (isdigit(b->data[at + n]) || b->data[at + n] == '.'))
                n++;
            *found = at;
            return n;
        }
    return 0;
}

/* Puts text in place of numbers between two places of a text, or bytes over aligned words where it is binary. */
static void put_numbers(tc_bytes *b, uint64_t *random, size_t from, size_t to, size_t count, const char *text,
                        const void *word, size_t word_bytes)
{
    for (size_t i = 0; i < count; i++) {
        to = least(to, b->n);
        size_t at = between(random, least(from, to), to), found = 0;
        size_t n = text_at(b, at) ? find_number(&found, b, at, to) : 0;
        if (n == 0 && text_at(b, at))
            n = find_number(&found, b, from, to);
        at &= ~(word_bytes - 1);
        if (n > 0)
            replace(b, found, n, text, strlen(text));
        else if (at + word_bytes <= b->n)
            memcpy(b->data + at, word, word_bytes);
    }
}

static void huge_count(tc_bytes *b, uint64_t *random, const tc_bytes *other)
{
    static const char *const text[] = {"999999999999", "4294967295", "2147483647", "99999999"};
    static const unsigned char word[2][4] = {{0x7f, 0xff, 0xff, 0xff}, {0xff, 0xff, 0xff, 0x3f}};
    (void)other;
    const char *with = text[tc_random(random) % 4];
    put_numbers(b, random, 0, 4 * HEAD, 2, with, word[tc_random(random) % 2], 4);
}

static void negative_count(tc_bytes *b, uint64_t *random, const tc_bytes *other)
{
    static const unsigned char word[8] = {0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff};
    (void)other;
    put_numbers(b, random, 0, 4 * HEAD, 2, "-7", word, 8);
}

static void not_finite(tc_bytes *b, uint64_t *random, const tc_bytes *other)
{
    static const char *const text[] = {"nan", "1e999", "inf"};
    static const unsigned char word[2][8] = {{0, 0, 0, 0, 0, 0, 0xf8, 0x7f}, {0x7f, 0xc0, 0, 0, 0x7f, 0xc0, 0, 0}};
    (void)other;
    put_numbers(b, random, head_of(b), b->n, 16, text[tc_random(random) % 3], word[tc_random(random) % 2], 8);
}

static void wild_index(tc_bytes *b, uint64_t *random, const tc_bytes *other)
{
    static const char *const text[] = {"2147483647", "-3", "1000000", "0"};
    static const unsigned char word[3][4] = {{0xff, 0xff, 0xff, 0x7f}, {0xfd, 0xff, 0xff, 0xff}, {0x40, 0x42, 0x0f, 0}};
    (void)other;
    put_numbers(b, random, head_of(b), b->n, 8, text[tc_random(random) % 4], word[tc_random(random) % 3], 4);
}

/* ---------------------------------------------------------------------------------------------- moved and strange */

static void splice(tc_bytes *b, uint64_t *random, const tc_bytes *other)
{
    size_t at = between(random, least(16, b->n), b->n), from = between(random, 0, other->n);
    replace(b, at, b->n - at, other->data + from, other->n - from);
}

static void repeat(tc_bytes *b, uint64_t *random, const tc_bytes *other)
{
    (void)other;
    unsigned char copy[4096];
    size_t from = between(random, 0, b->n), n = least(between(random, 16, sizeof copy), b->n - from);
    memcpy(copy, b->data + from, n);
    replace(b, between(random, head_of(b) / 2, b->n), 0, copy, n);
}

static void lose(tc_bytes *b, uint64_t *random, const tc_bytes *other)
{
    (void)other;
    size_t at = between(random, head_of(b) / 2, b->n);
    replace(b, at, least(between(random, 4, b->n / 16 + 5), b->n - at), "", 0);
}

static void garbage_head(tc_bytes *b, uint64_t *random, const tc_bytes *other)
{
    (void)other;
    size_t at = between(random, 0, head_of(b) / 2), end = least(b->n, at + 128);
    for (; at < end; at++)
        b->data[at] = (unsigned char)(32 + tc_random(random) % 95);
}

static void garbage_body(tc_bytes *b, uint64_t *random, const tc_bytes *other)
{
    (void)other;
    size_t at = between(random, head_of(b) / 2, b->n), end = least(b->n, at + 1024);
    for (; at < end; at++)
        b->data[at] = (unsigned char)tc_random(random);
}

/* Letters of words in the head: keywords, tags, names of attributes. */
static void wrong_words(tc_bytes *b, uint64_t *random, const tc_bytes *other)
{
    (void)other;
    for (int i = 0; i < 4; i++) {
        size_t at = between(random, 0, least(4 * HEAD, b->n)), end = least(b->n, at + 64);
        while (at < end && !isalpha(b->data[at]))
            at++;
        if (at < end)
            b->data[at] = (unsigned char)('A' + tc_random(random) % 26);
    }
}

static void line_ends(tc_bytes *b, uint64_t *random, const tc_bytes *other)
{
    (void)random, (void)other;
    size_t n = 0;
    for (size_t i = 0; i < b->n; i++)
        n += b->data[i] == '\n';
    unsigned char *out = malloc(b->n + n + 1);
    if (!out)
        abort();
    n = 0;
    for (size_t i = 0; i < b->n; i++) {
        if (b->data[i] == '\n')
            out[n++] = '\r';
        out[n++] = b->data[i];
    }
    free(b->data);
    b->data = out;
    b->n = n;
}

const tc_damage *tc_damage_list(size_t *n)
{
    static const tc_damage list[] = {
        {"cut-middle", "ends between a quarter and three quarters", TC_DAMAGE_BYTES, cut_middle},
        {"flip-head", "8 bits of the first 512 bytes turned", TC_DAMAGE_BYTES, flip_head},
        {"huge-count", "numbers near the start become huge", TC_DAMAGE_BYTES, huge_count},
        {"zero-body", "a block becomes zeros", TC_DAMAGE_BYTES, zero_body},
        {"wild-index", "numbers of the body out of every range", TC_DAMAGE_BYTES, wild_index},
        {"splice", "goes over into another file", TC_DAMAGE_BYTES, splice},
        {"wrong-name", "another format's extension", TC_DAMAGE_NAME, NULL},
        {"not-finite", "numbers of the body become NaN or Inf", TC_DAMAGE_BYTES, not_finite},
        {"cut-late", "the last hundredth to tenth is missing", TC_DAMAGE_BYTES, cut_late},
        {"flip-body", "a bit in 4096 bytes turned", TC_DAMAGE_BYTES, flip_body},
        {"negative-count", "numbers near the start become -7 or -1", TC_DAMAGE_BYTES, negative_count},
        {"lose", "a block is missing", TC_DAMAGE_BYTES, lose},
        {"wrong-words", "letters of words near the start changed", TC_DAMAGE_BYTES, wrong_words},
        {"empty", "no bytes at all", TC_DAMAGE_BYTES, cut_all},
        {"alone", "the files beside it are missing", TC_DAMAGE_COMPANY, NULL},
        {"garbage-body", "1 KiB of random bytes", TC_DAMAGE_BYTES, garbage_body},
        {"cut-last", "the last 1 to 16 bytes are missing", TC_DAMAGE_BYTES, cut_last},
        {"zero-head", "8 to 64 bytes near the start become zeros", TC_DAMAGE_BYTES, zero_head},
        {"flip-one", "one bit turned", TC_DAMAGE_BYTES, flip_one},
        {"cut-early", "ends before a quarter", TC_DAMAGE_BYTES, cut_early},
        {"repeat", "a block comes twice", TC_DAMAGE_BYTES, repeat},
        {"garbage-head", "128 letters of nonsense near the start", TC_DAMAGE_BYTES, garbage_head},
        {"zero-tail", "the last third becomes zeros", TC_DAMAGE_BYTES, zero_tail},
        {"cut-head", "ends within 64 bytes", TC_DAMAGE_BYTES, cut_head},
        {"line-ends", "line feeds become carriage return and line feed", TC_DAMAGE_BYTES, line_ends},
    };
    *n = sizeof list / sizeof *list;
    return list;
}
