/* file.c: a prepared mesh in a file, and back (layout: format.h). */
#define _GNU_SOURCE
#include "cache/belongings.h"
#include "cache/format.h"
#include "core/file.h"
#include "core/memory.h"
#include "mesh/mesh.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

enum { DESCRIPTION, VERTEX, TET, NEIGHBOUR, SCALAR, VERTEX_MAP, TET_MAP };
_Static_assert(TET_MAP + 1 == TC_CACHE_PARTS, "every part has its place in the head");

/* What of a mesh is no array; texts and lists follow it in the description. */
typedef struct facts {
    uint64_t n_vertex, n_tet, n_imaginary, n_vertex_source, n_tet_source;
    uint64_t source_hash, n_point, n_cell, n_array, n_block, n_cell_type, n_time, n_note, dropped_cells;
    int32_t association, asked, step, refine, linearised, maps;
    tc_mesh_report report;
    tc_file_repairs file;
} facts;

/* The bytes of each array of a mesh of these counts. */
static void array_bytes(uint64_t bytes[TC_CACHE_PARTS], const facts *f)
{
    uint64_t all = f->n_tet + f->n_imaginary;
    bytes[VERTEX] = 24 * f->n_vertex;
    bytes[TET] = bytes[NEIGHBOUR] = 16 * all;
    bytes[SCALAR] = 8 * (f->association == TC_CELL_DATA ? f->n_tet : f->n_vertex);
    bytes[VERTEX_MAP] = f->maps ? 4 * f->n_vertex_source : 0;
    bytes[TET_MAP] = f->maps ? 4 * f->n_tet_source : 0;
}

/* -------------------------------------------------------------------------------------------------------- saving */

/* A text with its length and end; length 0: NULL. At multiples of 8 bytes. */
static void put_text(FILE *stream, const char *text)
{
    static const char zeros[8];
    uint64_t n = text ? strlen(text) + 1 : 0;
    fwrite(&n, sizeof n, 1, stream);
    if (n > 0)
        fwrite(text, 1, n, stream);
    fwrite(zeros, 1, (8 - n % 8) % 8, stream);
}

static void put_facts(FILE *stream, const tc_mesh *m)
{
    const tc_source *s = m->source;
    facts f;
    memset(&f, 0, sizeof f);
    f.n_vertex = m->n_vertex, f.n_tet = m->n_tet, f.n_imaginary = m->n_imaginary;
    f.n_vertex_source = m->n_vertex_source, f.n_tet_source = m->n_tet_source;
    f.source_hash = m->source_hash;
    f.n_point = s->n_point, f.n_cell = s->n_cell, f.dropped_cells = s->dropped_cells;
    f.n_array = s->n_array, f.n_block = s->n_block, f.n_cell_type = s->n_cell_type;
    f.n_time = s->n_time, f.n_note = s->n_note;
    f.association = (int32_t)m->association;
    /* A helper that failed may do better next time: then the gaps are to be filled after loading. */
    f.asked = (int32_t)(m->gaps_may_do ? TC_REENTRY_PEEL : m->asked);
    f.step = s->step, f.refine = s->refine, f.linearised = s->linearised;
    f.maps = m->vertex_of_source && m->tet_of_source;
    f.report = m->report;
    f.report.ms_check = f.report.ms_adjacency = f.report.ms_order = f.report.ms_convexify = NAN;
    f.file = m->file;
    fwrite(&f, sizeof f, 1, stream);
}

static tc_status describe(char **out, size_t *n, const tc_mesh *m, tc_error *err)
{
    const tc_source *s = m->source;
    FILE *stream = open_memstream(out, n);
    if (!stream)
        return tc_fail_memory(err, "a cache file", 1, 4096);
    put_facts(stream, m);
    put_text(stream, m->field_name);
    put_text(stream, s->format);
    put_text(stream, s->reader);
    put_text(stream, s->field);
    for (size_t i = 0; i < s->n_array; i++) {
        const double numbers[4] = {s->array[i].lo, s->array[i].hi, (double)s->array[i].association,
                                   (double)s->array[i].components};
        put_text(stream, s->array[i].name);
        fwrite(numbers, sizeof numbers, 1, stream);
    }
    for (size_t i = 0; i < s->n_block; i++) {
        put_text(stream, s->block[i].name);
        fwrite(&s->block[i].number, sizeof s->block[i].number, 1, stream);
    }
    for (size_t i = 0; i < s->n_cell_type; i++) {
        const uint64_t numbers[2] = {(uint64_t)s->cell_type[i].dimension, s->cell_type[i].count};
        put_text(stream, s->cell_type[i].type);
        fwrite(numbers, sizeof numbers, 1, stream);
    }
    if (s->n_time)
        fwrite(s->time, sizeof *s->time, s->n_time, stream);
    for (size_t i = 0; i < s->n_note; i++)
        put_text(stream, s->note[i]);
    bool bad = ferror(stream) != 0;
    if (fclose(stream) != 0 || bad) {
        free(*out);
        *out = NULL;
        return tc_fail_memory(err, "a cache file", 1, 4096);
    }
    return TC_OK;
}

/* May path be written over? Not if it is somebody's file that was given by mistake. */
static bool ours(const char *path)
{
    size_t n = strlen(path);
    struct stat info;
    if (stat(path, &info) != 0 || info.st_size == 0 || (n > 8 && strcasecmp(path + n - 8, ".tccache") == 0))
        return true;
    return tc_cache_begins(path);
}

tc_status tc_mesh_save(const tc_mesh *mesh, const char *cache, const tc_cache_key *key, int threads, tc_error *err)
{
    if (!mesh || !cache || !key)
        return tc_fail(err, TC_E_ARG, "tc_mesh_save: mesh, cache or key is NULL");
    if (!mesh->prepared || !mesh->source)
        return tc_fail(err, TC_E_ARG, "only a mesh that was read from a file and prepared can be saved");
    if (!ours(cache))
        return tc_fail(err, TC_E_FILE, "%s is there and is no cache file; give another name", cache);
    facts f = {.n_vertex = mesh->n_vertex, .n_tet = mesh->n_tet, .n_imaginary = mesh->n_imaginary,
               .n_vertex_source = mesh->n_vertex_source, .n_tet_source = mesh->n_tet_source,
               .association = (int32_t)mesh->association, .maps = mesh->vertex_of_source && mesh->tet_of_source};
    tc_cache_head head;
    memset(&head, 0, sizeof head);
    memcpy(head.magic, TC_CACHE_MAGIC, sizeof head.magic);
    head.format = TC_CACHE_FORMAT;
    head.order = TC_CACHE_ORDER;
    head.key = *key;
    char *description = NULL;
    size_t n = 0;
    tc_status status = describe(&description, &n, mesh, err);
    if (status != TC_OK)
        return status;
    array_bytes(head.bytes, &f);
    head.bytes[DESCRIPTION] = n;
    const void *data[TC_CACHE_PARTS] = {description,  mesh->vertex,           mesh->tet,          mesh->neighbour,
                                        mesh->scalar, mesh->vertex_of_source, mesh->tet_of_source};
    tc_file_part part[1 + TC_CACHE_PARTS] = {{&head, sizeof head}};
    for (int i = 0; i < TC_CACHE_PARTS && status == TC_OK; i++) {
        part[i + 1] = (tc_file_part){data[i], (size_t)head.bytes[i]};
        status = tc_hash_array(&head.hash[i], data[i], (size_t)head.bytes[i], threads, err);
    }
    head.own = tc_hash_bytes(&head, offsetof(tc_cache_head, own), TC_CACHE_FORMAT);
    if (status == TC_OK)
        status = tc_file_replace_parts(cache, part, 1 + TC_CACHE_PARTS, err);
    free(description);
    return status;
}

/* ------------------------------------------------------------------------------------------------------- loading */

/* A description that is gone through; nothing is taken beyond its end. */
typedef struct cursor {
    char *at;
    size_t left;
    bool broken;
} cursor;

static void *take(cursor *c, size_t n)
{
    if (n > c->left) {
        c->broken = true;
        return NULL;
    }
    void *p = c->at;
    c->at += n;
    c->left -= n;
    return p;
}

static void take_copy(void *out, cursor *c, size_t n)
{
    const void *p = take(c, n);
    if (p)
        memcpy(out, p, n);
    else
        memset(out, 0, n);
}

static const char *take_text(cursor *c)
{
    uint64_t n;
    take_copy(&n, c, sizeof n);
    if (n == 0)
        return NULL;
    const char *text = n <= c->left ? take(c, (size_t)n + (8 - n % 8) % 8) : NULL;
    if (!text || text[n - 1] != 0) {
        c->broken = true;
        return NULL;
    }
    return text;
}

static tc_status fail_damaged(const char *cache, const char *what, tc_error *err)
{
    return tc_fail(err, TC_E_FILE, "%s is damaged (%s)", cache, what);
}

/* Gives m its source, whose texts lie in the description; one block holds that and the lists. */
static tc_status take_source(tc_mesh *m, const facts *f, const char *description, size_t n, const char *path,
                             tc_error *err)
{
    const size_t most = n / 8; /* each entry takes at least that */
    if (f->n_array > most || f->n_block > most || f->n_cell_type > most || f->n_time > most || f->n_note > most)
        return tc_fail(err, TC_E_FILE, "its lists are too long");
    size_t lists = (n + 15) / 16 * 16, path_bytes = strlen(path) + 1;
    size_t bytes = lists + f->n_array * sizeof(tc_array_info) + f->n_block * sizeof(tc_block_info) +
                   f->n_cell_type * sizeof(tc_cell_info) + f->n_time * sizeof(double) + f->n_note * sizeof(char *) + path_bytes;
    char *block = tc_alloc(bytes, 1);
    tc_source *s = tc_calloc(1, sizeof *s);
    m->source = s;
    m->source_memory = block;
    if (!block || !s)
        return tc_fail_memory(err, "the description of a file", bytes, 1);
    memcpy(block, description, n);
    cursor c = {block + sizeof *f, n - sizeof *f, false};
    tc_array_info *array = (void *)(block + lists);
    tc_block_info *blocks = (void *)(array + f->n_array);
    tc_cell_info *cell = (void *)(blocks + f->n_block);
    double *time = (void *)(cell + f->n_cell_type);
    const char **note = (void *)(time + f->n_time);
    char *name = (void *)(note + f->n_note);
    const char *field_name = take_text(&c);
    m->field_name = tc_strdup(field_name);
    if (field_name && !m->field_name)
        return tc_fail_memory(err, "a name", strlen(field_name), 1);
    s->format = take_text(&c);
    s->reader = take_text(&c);
    s->field = take_text(&c);
    for (size_t i = 0; i < f->n_array; i++) {
        double numbers[4];
        array[i].name = take_text(&c);
        take_copy(numbers, &c, sizeof numbers);
        array[i].lo = numbers[0], array[i].hi = numbers[1];
        array[i].association = numbers[2] == TC_CELL_DATA ? TC_CELL_DATA : TC_POINT_DATA;
        array[i].components = numbers[3] >= 0 && numbers[3] <= INT32_MAX ? (int)numbers[3] : 0;
    }
    for (size_t i = 0; i < f->n_block; i++) {
        blocks[i].name = take_text(&c);
        take_copy(&blocks[i].number, &c, sizeof blocks[i].number);
    }
    for (size_t i = 0; i < f->n_cell_type; i++) {
        uint64_t numbers[2];
        cell[i].type = take_text(&c);
        take_copy(numbers, &c, sizeof numbers);
        cell[i].dimension = (int)(numbers[0] & 3), cell[i].count = (size_t)numbers[1];
    }
    take_copy(time, &c, f->n_time * sizeof *time);
    for (size_t i = 0; i < f->n_note; i++)
        note[i] = take_text(&c);
    s->path = memcpy(name, path, path_bytes);
    s->array = array, s->block = blocks, s->cell_type = cell, s->time = time, s->note = note;
    s->n_point = (size_t)f->n_point, s->n_cell = (size_t)f->n_cell, s->dropped_cells = (size_t)f->dropped_cells;
    s->n_array = (size_t)f->n_array, s->n_block = (size_t)f->n_block, s->n_cell_type = (size_t)f->n_cell_type;
    s->n_time = (size_t)f->n_time, s->n_note = (size_t)f->n_note;
    s->step = f->step, s->refine = f->refine, s->linearised = f->linearised != 0;
    s->ms_read = NAN;
    return c.broken ? tc_fail(err, TC_E_FILE, "a text of it has no end") : TC_OK;
}

/* Are all of v within least … least + n - 1? */
static bool within(const int32_t *v, size_t count, int32_t least, size_t n)
{
    uint32_t most = 0;
    for (size_t i = 0; i < count; i++) {
        uint32_t x = (uint32_t)v[i] - (uint32_t)least;
        most = x > most ? x : most;
    }
    return count == 0 || most < n;
}

/* Head and description are good: allocates and reads the arrays. */
static tc_status read_arrays(tc_mesh *m, const facts *f, const tc_cache_head *head, int fd, int threads,
                             const char *cache, tc_error *err)
{
    uint64_t bytes[TC_CACHE_PARTS] = {head->bytes[DESCRIPTION]};
    array_bytes(bytes, f);
    if (f->n_vertex > INT32_MAX || f->n_tet + f->n_imaginary > (uint64_t)1 << 29 || f->n_vertex_source > INT32_MAX ||
        f->n_tet_source > (uint64_t)1 << 29 || memcmp(bytes, head->bytes, sizeof bytes) != 0)
        return fail_damaged(cache, "its counts do not fit", err);
    void *data[TC_CACHE_PARTS] = {NULL};
    for (int i = VERTEX; i < TC_CACHE_PARTS; i++)
        if (i < VERTEX_MAP || f->maps)
            data[i] = tc_alloc((size_t)bytes[i], 1);
    m->vertex = data[VERTEX], m->tet = data[TET], m->neighbour = data[NEIGHBOUR], m->scalar = data[SCALAR];
    m->vertex_of_source = data[VERTEX_MAP], m->tet_of_source = data[TET_MAP];
    uint64_t offset = sizeof *head + bytes[DESCRIPTION];
    for (int i = VERTEX; i < TC_CACHE_PARTS; i++) {
        tc_hash hash;
        if (!data[i] && (i < VERTEX_MAP || f->maps))
            return tc_fail_memory(err, cache, (size_t)bytes[i], 1);
        tc_status status = tc_hash_read(&hash, data[i], fd, offset, (size_t)bytes[i], threads, cache, err);
        if (status != TC_OK)
            return status;
        if (memcmp(&hash, &head->hash[i], sizeof hash) != 0)
            return fail_damaged(cache, "its contents have another hash than they should", err);
        offset += bytes[i];
    }
    size_t all = (size_t)(f->n_tet + f->n_imaginary), n_vertex = (size_t)f->n_vertex;
    if (!within(m->tet, 4 * all, 0, n_vertex) || !within(m->neighbour, 4 * all, -1, all + 1) ||
        (f->maps && (!within(m->vertex_of_source, (size_t)f->n_vertex_source, -1, n_vertex + 1) ||
                     !within(m->tet_of_source, (size_t)f->n_tet_source, -1, (size_t)f->n_tet + 1))))
        return fail_damaged(cache, "it names vertices or cells that are not there", err);
    return TC_OK;
}

/* Reads and checks the head and the description; *description is the caller's to free. */
static tc_status read_head(tc_cache_head *head, char **description, int fd, const tc_cache_key *key, int threads,
                           const char *cache, tc_error *err)
{
    struct stat info;
    tc_hash hash;
    if (fstat(fd, &info) != 0 || !S_ISREG(info.st_mode) || (uint64_t)info.st_size < sizeof *head)
        return fail_damaged(cache, "it is too short", err);
    tc_status status = tc_hash_read(&hash, head, fd, 0, sizeof *head, 1, cache, err);
    if (status != TC_OK)
        return status;
    if (memcmp(head->magic, TC_CACHE_MAGIC, sizeof head->magic) != 0)
        return tc_fail(err, TC_E_FILE, "%s is no cache file", cache);
    if (head->format != TC_CACHE_FORMAT || head->order != TC_CACHE_ORDER)
        return tc_fail(err, TC_E_FILE, "%s is of another version", cache);
    hash = tc_hash_bytes(head, offsetof(tc_cache_head, own), TC_CACHE_FORMAT);
    if (memcmp(&hash, &head->own, sizeof hash) != 0)
        return fail_damaged(cache, "its head has another hash than it should", err);
    if (memcmp(&head->key, key, sizeof *key) != 0)
        return tc_fail(err, TC_E_FILE, "%s is of another content, other settings or another build", cache);
    uint64_t left = (uint64_t)info.st_size - sizeof *head;
    for (int i = 0; i < TC_CACHE_PARTS; i++) {
        if (head->bytes[i] > left)
            return fail_damaged(cache, "it is cut short", err);
        left -= head->bytes[i];
    }
    size_t n = (size_t)head->bytes[DESCRIPTION];
    if (left != 0 || n < sizeof(facts))
        return fail_damaged(cache, "its parts do not fit", err);
    *description = tc_alloc(n, 1);
    if (!*description)
        return tc_fail_memory(err, cache, n, 1);
    status = tc_hash_read(&hash, *description, fd, sizeof *head, n, threads, cache, err);
    if (status == TC_OK && memcmp(&hash, &head->hash[DESCRIPTION], sizeof hash) != 0)
        status = fail_damaged(cache, "its description has another hash than it should", err);
    return status;
}

tc_status tc_mesh_load(tc_mesh **out, const char *cache, const tc_cache_key *key, const char *path, int threads,
                       const tc_log *log, tc_error *err)
{
    if (!out || !cache || !key || !path)
        return tc_fail(err, TC_E_ARG, "tc_mesh_load: out, cache, key or path is NULL");
    *out = NULL;
    tc_cache_head head;
    facts f;
    char *description = NULL;
    int fd = open(cache, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (fd < 0)
        return tc_fail(err, TC_E_FILE, "%s cannot be read: %s", cache, strerror(errno));
    tc_mesh *m = tc_calloc(1, sizeof *m);
    tc_status status = m ? read_head(&head, &description, fd, key, threads, cache, err)
                         : tc_fail_memory(err, "a mesh", 1, sizeof *m);
    if (status == TC_OK) {
        memcpy(&f, description, sizeof f);
        status = take_source(m, &f, description, (size_t)head.bytes[DESCRIPTION], path, err);
        if (status == TC_E_FILE)
            tc_fail_prefix(err, status, "%s is damaged: ", cache);
    }
    if (status == TC_OK)
        status = read_arrays(m, &f, &head, fd, threads, cache, err);
    close(fd);
    free(description);
    if (status != TC_OK) {
        tc_mesh_destroy(&m);
        return status;
    }
    m->n_vertex = (size_t)f.n_vertex, m->n_tet = (size_t)f.n_tet, m->n_imaginary = (size_t)f.n_imaginary;
    m->n_vertex_source = (size_t)f.n_vertex_source, m->n_tet_source = (size_t)f.n_tet_source;
    m->association = f.association == TC_CELL_DATA ? TC_CELL_DATA : TC_POINT_DATA;
    m->asked = (tc_reentry)f.asked;
    m->gaps_may_do = false;
    m->source_hash = f.source_hash;
    m->report = f.report;
    m->file = f.file;
    m->serial = tc_mesh_new_serial();
    m->scalar_serial = tc_mesh_new_serial();
    m->prepared = true;
    tc_mesh_say_defects(log, &m->report);
    if (m->report.reentry_why[0])
        tc_say(log, TC_INFO, "re-entry by depth peeling is used: %s", m->report.reentry_why);
    *out = m;
    return TC_OK;
}
