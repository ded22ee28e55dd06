/* program.c: assembles, compiles and caches GL programs.
 * #include is resolved once per file; `#line` carries file*10000 + line, since llvmpipe's logs lose the source-string
 * number. */
#include "gpu/program.h"

#include "core/file.h"
#include "core/memory.h"
#include "core/parallel.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { LINES_PER_FILE = 10000, MAX_FILES = 128, DEEPEST = 12, LOG_BYTES = 4096 };

typedef struct text {
    char *data;
    size_t n, capacity;
} text;

typedef struct assembly {
    text out;
    bool included[MAX_FILES];
    const char *alias, *effects;
    tc_error *err;
} assembly;

static tc_status text_add(text *t, const char *data, size_t n, tc_error *err)
{
    if (t->n + n + 1 > t->capacity) {
        size_t capacity = (t->n + n + 1) * 2;
        char *grown = tc_realloc(t->data, capacity, 1);
        if (!grown)
            return tc_fail_memory(err, "a shader's text", capacity, 1);
        t->data = grown;
        t->capacity = capacity;
    }
    memcpy(t->data + t->n, data, n);
    t->n += n;
    t->data[t->n] = 0;
    return TC_OK;
}

static int file_index(const char *name, size_t n)
{
    for (int i = 0; tc_shader_files[i].name && i < MAX_FILES; i++)
        if (strlen(tc_shader_files[i].name) == n && strncmp(tc_shader_files[i].name, name, n) == 0)
            return i;
    return -1;
}

/* alias "from=to from=to": gives the index of `to` where name is `from`. */
static int resolve(const assembly *a, const char *name, size_t n)
{
    for (const char *pair = a->alias; pair && *pair; pair += strspn(pair, " ")) {
        size_t length = strcspn(pair, " "), from = strcspn(pair, "=");
        if (from < length && from == n && strncmp(pair, name, n) == 0)
            return file_index(pair + from + 1, length - from - 1);
        pair += length;
    }
    return file_index(name, n);
}

/* The file of that name in the folder TETCAST_SHADERS names, 0-terminated, for the caller to free; NULL where the
 * embedded one is to be taken. For trying out changes without a build, and for tests that break a shader on purpose. */
static const char *override_folder(void)
{
    const char *folder = getenv("TETCAST_SHADERS");
    return folder && *folder ? folder : NULL;
}

static tc_status read_override(char **out, const char *name, tc_error *err)
{
    *out = NULL;
    const char *folder = override_folder();
    char path[4096];
    if (!folder || snprintf(path, sizeof path, "%s/%s", folder, name) >= (int)sizeof path ||
        access(path, F_OK) != 0)
        return TC_OK;
    void *data;
    size_t bytes;
    tc_status status = tc_file_read(&data, &bytes, path, err);
    if (status != TC_OK)
        return status;
    *out = tc_realloc(data, bytes + 1, 1);
    if (!*out) {
        free(data);
        return tc_fail_memory(err, "a shader's text", bytes + 1, 1);
    }
    (*out)[bytes] = 0;
    return TC_OK;
}

static tc_status add_lines(assembly *a, int index, const char *p, int line, const char *section, int depth);

/* The text of file `index`; *override is to be freed. */
static tc_status file_text(const char **out, char **override, int index, tc_error *err)
{
    tc_status status = read_override(override, tc_shader_files[index].name, err);
    *out = *override ? *override : tc_shader_files[index].text;
    return status;
}

static tc_status add_file(assembly *a, int index, int depth)
{
    if (a->included[index])
        return TC_OK;
    a->included[index] = true;
    if (depth > DEEPEST)
        return tc_fail(a->err, TC_E_GL, "shader %s: includes nest too deep", tc_shader_files[index].name);
    char *override;
    const char *whole;
    tc_status status = file_text(&whole, &override, index, a->err);
    if (status == TC_OK)
        status = add_lines(a, index, whole, 1, NULL, depth);
    free(override);
    return status;
}

static tc_status add_line_directive(assembly *a, int index, int line)
{
    char directive[64];
    snprintf(directive, sizeof directive, "#line %d\n", index * LINES_PER_FILE + line);
    return text_add(&a->out, directive, strlen(directive), a->err);
}

/* Is the line "//@section NAME", of this name or, with NULL, of any? */
static bool begins_section(const char *line, const char *name)
{
    static const char mark[] = "//@section ";
    if (strncmp(line, mark, sizeof mark - 1) != 0)
        return false;
    const char *begin = line + sizeof mark - 1;
    size_t n = strcspn(begin, " \n");
    return !name || (strlen(name) == n && strncmp(begin, name, n) == 0);
}

/* Adds the sections of this name of all effects; *n gets their number. With add false they are counted alone. */
static tc_status add_sections(assembly *a, int *n, const char *name, bool add, int depth)
{
    tc_status status = TC_OK;
    *n = 0;
    if (depth > DEEPEST)
        return tc_fail(a->err, TC_E_GL, "shaders: the places of effects nest too deep at %s", name);
    for (const char *file = a->effects; file && *file && status == TC_OK; file += strspn(file, " ")) {
        size_t length = strcspn(file, " ");
        int index = file_index(file, length), line = 0;
        char *override = NULL;
        const char *p;
        if (index < 0)
            return tc_fail(a->err, TC_E_GL, "there is no shader %.*s", (int)length, file);
        status = file_text(&p, &override, index, a->err);
        while (status == TC_OK && *p) {
            const char *end = strchr(p, '\n');
            end = end ? end + 1 : p + strlen(p);
            line++;
            if (begins_section(p, name)) {
                ++*n;
                if (add)
                    status = add_lines(a, index, end, line + 1, name, depth + 1);
            }
            p = end;
        }
        free(override);
        file += length;
    }
    return status;
}

/* What a line's marks say: how long the line is without them, and the places' names; "": none. */
typedef struct mark {
    size_t length;
    char or [64], then[64];
} mark;

/* The name behind a mark that begins at `at`, into name; false where there is no such mark. */
static bool read_mark(char name[64], const char *at, const char *kind)
{
    size_t length = strlen(kind), n;
    if (strncmp(at, kind, length) != 0)
        return false;
    n = strcspn(at + length, " \n");
    if (n >= 64)
        return false;
    memcpy(name, at + length, n);
    name[n] = 0;
    return true;
}

static mark find_mark(const char *p, const char *end)
{
    mark m = {(size_t)(end - p), "", ""};
    for (const char *at = p; at + 10 < end; at++)
        if ((read_mark(m.or, at, " //@or ") || read_mark(m.then, at, " //@then ")) && m.length > (size_t)(at - p))
            m.length = (size_t)(at - p);
    return m;
}

/* Adds one line of a file, without its end. */
static tc_status add_line(assembly *a, int index, int line, const char *p, size_t length, int depth)
{
    if (strncmp(p, "#include \"", 10) != 0) {
        tc_status status = text_add(&a->out, p, length, a->err);
        return status == TC_OK ? text_add(&a->out, "\n", 1, a->err) : status;
    }
    const char *name = p + 10, *quote = strchr(name, '"');
    int other = quote ? resolve(a, name, (size_t)(quote - name)) : -1;
    if (other < 0)
        return tc_fail(a->err, TC_E_GL, "shader %s:%d includes a file that does not exist", tc_shader_files[index].name,
                       line);
    tc_status status = add_file(a, other, depth + 1);
    return status == TC_OK ? add_line_directive(a, index, line + 1) : status;
}

/* Adds the text p of file `index`, which begins at `line`, and what it includes; a section of it ends where the next
 * one begins. */
static tc_status add_lines(assembly *a, int index, const char *p, int line, const char *section, int depth)
{
    char taken[64] = ""; /* the place of the lines before, where they gave way */
    tc_status status = add_line_directive(a, index, line);
    for (; status == TC_OK && *p && !(section && begins_section(p, NULL)); line++) {
        const char *next = strchr(p, '\n'), *end = next ? next : p + strlen(p);
        mark m = find_mark(p, end);
        int n = 0;
        if (*m.or &&strcmp(taken, m.or) != 0)
            status = add_sections(a, &n, m.or, false, depth);
        if (status == TC_OK && n > 1)
            return tc_fail(a->err, TC_E_GL, "shader %s:%d: two effects take the place %s, or one of them twice",
                           tc_shader_files[index].name, line, m.or);
        if (*m.or &&n == 1) {
            snprintf(taken, sizeof taken, "%s", m.or);
            status = add_sections(a, &n, m.or, true, depth);
        } else if (!*m.or || strcmp(taken, m.or) != 0) {
            if (*taken) { /* the first line behind those that gave way */
                status = status == TC_OK ? add_line_directive(a, index, line) : status;
                *taken = 0;
            }
            if (status == TC_OK)
                status = add_line(a, index, line, p, m.length, depth);
        }
        if (status == TC_OK && *m.then) {
            status = add_sections(a, &n, m.then, true, depth);
            if (status == TC_OK && n > 0)
                status = add_line_directive(a, index, line + 1);
        }
        p = next ? next + 1 : end;
    }
    return status;
}

tc_status tc_program_text(char **out, const char *file, const char *defines, const char *alias, const char *effects,
                          tc_error *err)
{
    *out = NULL;
    assembly a = {.alias = alias, .effects = effects, .err = err};
    int index = file_index(file, strlen(file));
    if (index < 0)
        return tc_fail(err, TC_E_GL, "there is no shader %s", file);
    static const char head[] = "#version 430 core\n";
    tc_status status = text_add(&a.out, head, sizeof head - 1, err);
    if (status == TC_OK && defines)
        status = text_add(&a.out, defines, strlen(defines), err);
    if (status == TC_OK)
        status = add_file(&a, index, 0);
    if (status != TC_OK) {
        free(a.out.data);
        return status;
    }
    *out = a.out.data;
    return TC_OK;
}

typedef struct entry {
    char *vertex, *fragment; /* final texts: the key; vertex NULL: the other is a compute shader's */
    GLuint program;
    const char *name;
    size_t bytes;
    bool used; /* since the last mark */
} entry;

typedef struct asked {
    char *key;    /* source_key */
    size_t place; /* among the entries */
} asked;

struct tc_program_cache {
    const tc_gl *gl;
    entry *entries;
    size_t n;
    asked *asked;
    size_t n_asked;
    double ms;
};

tc_status tc_program_cache_create(tc_program_cache **out, const tc_gl *gl, tc_error *err)
{
    *out = tc_calloc(1, sizeof **out);
    if (!*out)
        return tc_fail_memory(err, "the program cache", 1, sizeof **out);
    (*out)->gl = gl;
    return TC_OK;
}

/* Turns the first "0:1234567(…)" or "0(1234567)" of a compiler's log into the file's name and line. */
static tc_status compile_error(const char *log, const char *file, tc_error *err)
{
    for (const char *p = log; *p; p++) {
        char *end;
        long number = strtol(p, &end, 10);
        if (end != p && number > 20) {
            long index = number / LINES_PER_FILE, line = number % LINES_PER_FILE;
            int n = 0;
            while (tc_shader_files[n].name)
                n++;
            if (index < n)
                return tc_fail(err, TC_E_GL, "shader %s:%ld: %.600s", tc_shader_files[index].name, line, end);
        }
        if (end != p)
            p = end - 1;
    }
    return tc_fail(err, TC_E_GL, "shader %s: %.600s", file, log);
}

static tc_status compile(GLuint *shader, const tc_gl *gl, GLenum stage, const char *source, const char *file,
                         tc_error *err)
{
    *shader = gl->CreateShader(stage);
    gl->ShaderSource(*shader, 1, &source, NULL);
    gl->CompileShader(*shader);
    GLint ok = 0;
    gl->GetShaderiv(*shader, GL_COMPILE_STATUS, &ok);
    if (ok)
        return TC_OK;
    char log[LOG_BYTES] = "";
    gl->GetShaderInfoLog(*shader, sizeof log, NULL, log);
    gl->DeleteShader(*shader);
    *shader = 0;
    return compile_error(log, file, err);
}

static tc_status build(GLuint *program, const tc_gl *gl, const char *vertex_text, const char *fragment_text,
                       const tc_program_source *source, tc_error *err)
{
    GLuint vertex = 0, fragment = 0;
    *program = 0;
    tc_status status = vertex_text ? compile(&vertex, gl, GL_VERTEX_SHADER, vertex_text, source->vertex, err) : TC_OK;
    if (status == TC_OK)
        status = compile(&fragment, gl, vertex_text ? GL_FRAGMENT_SHADER : GL_COMPUTE_SHADER, fragment_text,
                         source->fragment, err);
    if (status == TC_OK) {
        *program = gl->CreateProgram();
        if (vertex)
            gl->AttachShader(*program, vertex);
        gl->AttachShader(*program, fragment);
        gl->LinkProgram(*program);
        GLint ok = 0;
        gl->GetProgramiv(*program, GL_LINK_STATUS, &ok);
        if (!ok) {
            char log[LOG_BYTES] = "";
            gl->GetProgramInfoLog(*program, sizeof log, NULL, log);
            gl->DeleteProgram(*program);
            *program = 0;
            status = tc_fail(err, TC_E_GL, "linking %s%s%s: %.600s", source->vertex ? source->vertex : "",
                             source->vertex ? " and " : "", source->fragment, log);
        }
    }
    if (vertex)
        gl->DeleteShader(vertex);
    if (fragment)
        gl->DeleteShader(fragment);
    if (status != TC_OK)
        (void)tc_gl_check(gl, "compiling", NULL); /* GL's debug output told the same */
    return status;
}

static bool same(const char *a, const char *b)
{
    return a && b ? strcmp(a, b) == 0 : a == b;
}

/* What is asked for, as one text. malloc'd; NULL: out of memory. */
static char *source_key(const tc_program_source *s)
{
    const char *part[] = {s->vertex, s->fragment, s->defines, s->alias, s->effects};
    enum { PARTS = sizeof part / sizeof *part };
    size_t n = 1;
    for (int i = 0; i < PARTS; i++)
        n += (part[i] ? strlen(part[i]) : 0) + 1;
    char *key = tc_alloc(n, 1), *at = key;
    for (int i = 0; i < PARTS && key; i++) {
        const size_t length = part[i] ? strlen(part[i]) : 0;
        memcpy(at, part[i] ? part[i] : "", length);
        at += length;
        *at++ = '\x1f'; /* in no name and no line */
    }
    if (key)
        *at = 0;
    return key;
}

/* The program of the text that the source stands for, made if there is none: its place among the entries. */
static tc_status find_program(size_t *place, tc_program_cache *cache, const tc_program_source *source, tc_error *err)
{
    char *vertex = NULL, *fragment = NULL;
    tc_status status =
        source->vertex ? tc_program_text(&vertex, source->vertex, source->defines, source->alias, source->effects, err)
                       : TC_OK;
    if (status == TC_OK)
        status = tc_program_text(&fragment, source->fragment, source->defines, source->alias, source->effects, err);
    if (status != TC_OK)
        goto done;
    for (*place = 0; *place < cache->n; ++*place)
        if (same(cache->entries[*place].vertex, vertex) && same(cache->entries[*place].fragment, fragment))
            goto done;
    entry *grown = tc_realloc(cache->entries, cache->n + 1, sizeof *grown);
    if (!grown) {
        status = tc_fail_memory(err, "the program cache", cache->n + 1, sizeof *grown);
        goto done;
    }
    cache->entries = grown;
    GLuint program;
    double start = tc_now_ms();
    status = build(&program, cache->gl, vertex, fragment, source, err);
    cache->ms += tc_now_ms() - start;
    if (status == TC_OK) {
        int file = file_index(source->fragment, strlen(source->fragment));
        grown[cache->n++] = (entry){
            vertex, fragment, program, tc_shader_files[file].name, strlen(fragment) + (vertex ? strlen(vertex) : 0),
            false};
        vertex = fragment = NULL;
    }
done:
    free(vertex);
    free(fragment);
    return status;
}

tc_status tc_program_get(GLuint *program, tc_program_cache *cache, const tc_program_source *source, tc_error *err)
{
    *program = 0;
    char *key = source_key(source);
    size_t place = 0, k = 0;
    if (!key)
        return tc_fail_memory(err, "the program cache", 1, 1024);
    while (k < cache->n_asked && strcmp(cache->asked[k].key, key) != 0)
        k++;
    if (override_folder()) /* files may have changed */
        k = cache->n_asked;
    if (k < cache->n_asked) { /* as nearly always: texts of programs are long to put together */
        free(key);
        place = cache->asked[k].place;
    } else {
        tc_status status = find_program(&place, cache, source, err);
        asked *grown = status == TC_OK ? tc_realloc(cache->asked, cache->n_asked + 1, sizeof *grown) : NULL;
        if (grown) {
            cache->asked = grown;
            grown[cache->n_asked++] = (asked){key, place};
        } else {
            free(key);
        }
        if (status != TC_OK)
            return status;
    }
    *program = cache->entries[place].program;
    cache->entries[place].used = true;
    return TC_OK;
}

void tc_program_cache_mark(tc_program_cache *cache)
{
    for (size_t i = 0; i < cache->n; i++)
        cache->entries[i].used = false;
}

bool tc_program_cache_used(const char **name, size_t *bytes, const tc_program_cache *cache, size_t k)
{
    for (size_t i = 0; i < cache->n; i++)
        if (cache->entries[i].used && k-- == 0) {
            *name = cache->entries[i].name;
            *bytes = cache->entries[i].bytes;
            return true;
        }
    return false;
}

double tc_program_cache_ms(const tc_program_cache *cache)
{
    return cache->ms;
}

void tc_program_cache_destroy(tc_program_cache **cache)
{
    if (!*cache)
        return;
    for (size_t i = 0; i < (*cache)->n; i++) {
        (*cache)->gl->DeleteProgram((*cache)->entries[i].program);
        free((*cache)->entries[i].vertex);
        free((*cache)->entries[i].fragment);
    }
    for (size_t i = 0; i < (*cache)->n_asked; i++)
        free((*cache)->asked[i].key);
    free((*cache)->entries);
    free((*cache)->asked);
    free(*cache);
    *cache = NULL;
}
