/* corrupt_kinds.h: ways to damage the bytes of a file, each a pure function of a seed. */
#ifndef TC_TESTS_CORRUPT_KINDS_H
#define TC_TESTS_CORRUPT_KINDS_H

#include <stddef.h>
#include <stdint.h>

typedef struct tc_bytes {
    unsigned char *data; /* owned, malloc */
    size_t n;
} tc_bytes;

/* Whether a kind changes the bytes, the file's name, or the files beside it. */
typedef enum tc_damage_to { TC_DAMAGE_BYTES, TC_DAMAGE_NAME, TC_DAMAGE_COMPANY } tc_damage_to;

typedef struct tc_damage {
    const char *name, *what;
    tc_damage_to to;
    void (*apply)(tc_bytes *bytes, uint64_t *random, const tc_bytes *other); /* TC_DAMAGE_BYTES */
} tc_damage;

/* All kinds; *n gets their count. */
const tc_damage *tc_damage_list(size_t *n);

/* The next number of a sequence that *state is the place in (Steele, Lea, Flood 2014, "Fast splittable pseudorandom
 * number generators"). */
uint64_t tc_random(uint64_t *state);

#endif
