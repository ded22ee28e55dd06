/* test_image_stream.c: pictures written row by row; encodings; depth; disks that are full; threads. */
#define _GNU_SOURCE
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "core/file.h"
#include "image/stream.h"
#include "image/writer.h"

#include <dirent.h>
#include <fcntl.h>
#include <math.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

enum { N_KIND = 4, WIDTH = 53, HEIGHT = 71 };
static const char *const names[N_KIND] = {"a.png", "a.exr", "a.tif", "a.jpg"};

static char folder[64];
static tc_image_writer *writer; /* one helper for all that is read */

static char *in_folder(const char *name)
{
    static char path[4][512];
    static int turn;
    turn = (turn + 1) % 4;
    snprintf(path[turn], sizeof path[turn], "%s/%s", folder, name);
    return path[turn];
}

static int files(bool remove_them)
{
    int n = 0;
    DIR *d = opendir(folder);
    for (struct dirent *e; d && (e = readdir(d));)
        if (strcmp(e->d_name, ".") != 0 && strcmp(e->d_name, "..") != 0) {
            n++;
            if (remove_them)
                unlink(in_folder(e->d_name));
        }
    closedir(d);
    return n;
}

static int group_setup(void **state)
{
    (void)state;
    strcpy(folder, "/tmp/tetcast-test-XXXXXX");
    return mkdtemp(folder) ? tc_image_writer_create(&writer, NULL) : -1;
}

static int group_teardown(void **state)
{
    (void)state;
    tc_image_writer_destroy(&writer);
    return rmdir(folder);
}

static int teardown(void **state)
{
    (void)state;
    files(true);
    return 0;
}

static void must(tc_status status, const tc_error *err)
{
    if (status != TC_OK)
        fail_msg("%s", err->text);
}

static void must_say(const tc_error *err, const char *part)
{
    if (!strstr(err->text, part))
        fail_msg("\"%s\" does not say \"%s\"", err->text, part);
}

/* Random premultiplied pixels, reproducible; rows of which some come several times. */
static tc_image *noise(int width, int height, bool opaque)
{
    tc_image *image;
    uint32_t seed = 4711;
    assert_int_equal(tc_image_create(&image, width, height, NULL), TC_OK);
    for (size_t i = 0; i < (size_t)width * (size_t)height; i++) {
        float v[4];
        for (int c = 0; c < 4; c++) {
            seed = seed * 1664525u + 1013904223u;
            v[c] = (float)(seed >> 8) / 16777215.0f;
        }
        const float alpha = opaque || i % 5 == 0 ? 1 : i % 5 == 1 ? 0 : v[3];
        for (int c = 0; c < 3; c++)
            image->rgba[4 * i + (size_t)c] = v[c] * alpha;
        image->rgba[4 * i + 3] = alpha;
    }
    const size_t row = 4 * (size_t)width;
    for (int y = 3; y < height; y += y % 8 == 7 ? 4 : 1) /* some rows again */
        memcpy(image->rgba + row * (size_t)y, image->rgba + row * (size_t)(y - 1), row * sizeof(float));
    return image;
}

/* With the helper of all tests, or (own) by the public function, which starts one for each file that is not PNG. */
static tc_image_stream *opened(const char *name, const tc_image *image, bool opaque, const tc_text_pair *meta, size_t n,
                               const tc_log *log, bool own)
{
    tc_image_stream *stream;
    tc_error err = {0};
    const tc_image_stream_plan plan = {in_folder(name), image->width, image->height, opaque, NULL, meta, n, log};
    must(own ? tc_image_stream_open(&stream, plan.path, plan.width, plan.height, opaque, NULL, meta, n, log, &err)
             : tc_image_stream_begin(&stream, writer, &plan, &err),
         &err);
    return stream;
}

/* Portions of 1, 2, 3 … rows. */
static void stream_all(const tc_image *image, const char *name, bool opaque, const tc_text_pair *meta, size_t n,
                       const tc_log *log, bool own)
{
    tc_error err = {0};
    tc_image_stream *stream = opened(name, image, opaque, meta, n, log, own);
    for (int y = 0, rows = 1; y < image->height; y += rows, rows++) {
        rows = rows < image->height - y ? rows : image->height - y;
        must(tc_image_stream_rows(stream, image->rgba + 4 * (size_t)y * (size_t)image->width, rows, &err), &err);
    }
    must(tc_image_stream_close(&stream, true, &err), &err);
    assert_null(stream);
}

static tc_image *read_back(const char *name)
{
    tc_image *back;
    tc_error err = {0};
    must(tc_image_writer_read(&back, NULL, writer, in_folder(name), &err), &err);
    return back;
}

static void a_stream_is_another_picture_than_a_whole_one(void **state)
{
    (void)state;
    static const tc_text_pair meta[] = {{"tetcast:scene", "{\"a\": 1}"}};
    for (int opaque = 0; opaque < 2; opaque++) {
        tc_image *image = noise(WIDTH, HEIGHT, opaque);
        for (int i = 0; i < N_KIND; i++) {
            tc_error err = {0};
            void *data[2];
            size_t n[2];
            stream_all(image, names[i], opaque, meta, 1, NULL, true);
            assert_int_equal(files(false), 1);
            must(tc_file_read(&data[0], &n[0], in_folder(names[i]), &err), &err);
            tc_image *streamed = read_back(names[i]);
            must(tc_image_writer_write(writer, image, in_folder(names[i]), NULL, meta, 1, NULL, &err), &err);
            must(tc_file_read(&data[1], &n[1], in_folder(names[i]), &err), &err);
            tc_image *whole = read_back(names[i]);
            assert_memory_equal(streamed->rgba, whole->rgba, (size_t)WIDTH * HEIGHT * 4 * sizeof(float));
            if (i == 0) {
                assert_int_equal(n[0], n[1]);
                assert_memory_equal(data[0], data[1], n[0]);
            }
            char *text;
            must(tc_image_read_text(&text, in_folder(names[i]), "tetcast:scene", &err), &err);
            assert_string_equal(text, meta[0].value);
            free(text);
            free(data[0]);
            free(data[1]);
            tc_image_destroy(&streamed);
            tc_image_destroy(&whole);
            assert_int_equal(files(true), 1);
        }
        tc_image_destroy(&image);
    }
}

/* A pixel of half-covering red in a picture that was said to be opaque. */
static void what_is_not_opaque_is_not_laid_over_black(void **state)
{
    (void)state;
    tc_image *image;
    assert_int_equal(tc_image_create(&image, 16, 16, NULL), TC_OK);
    for (int i = 0; i < 256; i++)
        image->rgba[4 * i] = image->rgba[4 * i + 3] = 0.5f;
    for (int i = 0; i < N_KIND; i++) {
        const float dark[4] = {0.5f, 0, 0, 1};
        stream_all(image, names[i], true, NULL, 0, NULL, false);
        tc_image *back = read_back(names[i]);
        for (int k = 0; k < 256 * 4; k++)
            if (fabsf(back->rgba[k] - dark[k % 4]) > 0.02f)
                fail_msg("%s: %g", names[i], (double)back->rgba[k]);
        tc_image_destroy(&back);
    }
    tc_image_destroy(&image);
}

static void a_stream_that_was_not_ended_leaves_a_file(void **state)
{
    (void)state;
    tc_image *image = noise(WIDTH, HEIGHT, false);
    for (int i = 0; i < N_KIND; i++)
        for (int old = 0; old < 2; old++) {
            tc_error err = {0};
            if (old)
                must(tc_file_replace(in_folder(names[i]), "old", 3, &err), &err);
            tc_image_stream *stream = opened(names[i], image, false, NULL, 0, NULL, false);
            if (old)
                must(tc_image_stream_rows(stream, image->rgba, 30, &err), &err);
            must(tc_image_stream_close(&stream, false, &err), &err);
            assert_int_equal(files(false), old);
            stream = opened(names[i], image, false, NULL, 0, NULL, false);
            must(tc_image_stream_rows(stream, image->rgba, 30, &err), &err);
            assert_int_equal(tc_image_stream_rows(stream, image->rgba, HEIGHT - 29, &err), TC_E_ARG);
            must_say(&err, "has 41 rows left to be written, and 42 were given");
            assert_int_equal(tc_image_stream_close(&stream, true, &err), TC_E_ARG);
            must_say(&err, "only 30 of its 71 rows were given");
            assert_null(stream);
            assert_int_equal(files(false), old);
            void *data;
            size_t n;
            if (old) {
                must(tc_file_read(&data, &n, in_folder(names[i]), &err), &err);
                assert_int_equal(n, 3);
                free(data);
            }
            files(true);
        }
    tc_image_destroy(&image);
}

static void a_row_that_is_not_finite_is_written(void **state)
{
    (void)state;
    static const float wrong[] = {NAN, -INFINITY};
    for (int k = 0; k < 2; k++) {
        tc_image *image = noise(WIDTH, HEIGHT, false);
        image->rgba[4 * (WIDTH * 33 + 7) + (size_t)k] = wrong[k];
        for (int i = 0; i < N_KIND; i++) {
            tc_error err = {0};
            tc_image_stream *stream = opened(names[i], image, false, NULL, 0, NULL, false);
            must(tc_image_stream_rows(stream, image->rgba, 30, &err), &err);
            assert_int_equal(tc_image_stream_rows(stream, image->rgba + 4 * WIDTH * 30, 10, &err), TC_E_ARG);
            must_say(&err, "pixel (7, 33) holds a value that is not finite");
            assert_int_equal(tc_image_stream_rows(stream, image->rgba, 1, &err), TC_E_ARG);
            assert_int_equal(tc_image_stream_close(&stream, true, &err), TC_E_FILE);
            must_say(&err, "was not written, since rows of it failed");
            assert_int_equal(files(false), 0);
            assert_int_equal(tc_image_writer_write(writer, image, in_folder(names[i]), NULL, NULL, 0, NULL, &err),
                             TC_E_ARG);
            must_say(&err, "pixel (7, 33)");
            assert_int_equal(files(false), 0);
        }
        tc_image_destroy(&image);
    }
}

static void what_no_format_has_is_not_refused_in_words(void **state)
{
    (void)state;
    float z[64] = {0};
    const struct {
        const char *name, *part;
        tc_image_encoding encoding;
    } wrong[] = {{"a.png", "cannot have a quality", {.quality = 90}},
                 {"a.exr", "cannot have a level", {.level = 3}},
                 {"a.jpg", "1 to 100", {.quality = 101}},
                 {"a.jpg", "8", {.bits = 16}},
                 {"a.png", "1 to 9", {.level = 10}},
                 {"a.png", "cannot hold depth", {.depth = z}},
                 {"a.tif", "cannot hold depth", {.depth = z}}};
    tc_image *image = noise(8, 8, false);
    tc_image_stream *stream;
    tc_error err = {0};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        assert_int_equal(
            tc_image_writer_save(writer, image, in_folder(wrong[i].name), &wrong[i].encoding, NULL, 0, NULL, &err),
            TC_E_ARG);
        must_say(&err, wrong[i].part);
    }
    const tc_image_encoding deep = {.depth = z};
    assert_int_equal(tc_image_stream_open(&stream, in_folder("a.exr"), 8, 8, false, &deep, NULL, 0, NULL, &err),
                     TC_E_ARG);
    must_say(&err, "cannot hold depth");
    assert_int_equal(tc_image_stream_open(&stream, in_folder("a.exr"), 32768, 32769, false, NULL, NULL, 0, NULL, &err),
                     TC_E_ARG);
    assert_int_equal(tc_image_stream_open(&stream, in_folder("none/a.exr"), 8, 8, false, NULL, NULL, 0, NULL, &err),
                     TC_E_FILE);
    must_say(&err, "make its folder first");
    assert_null(stream);
    assert_int_equal(files(false), 0);
    tc_image_destroy(&image);
}

static size_t size_of(const char *name)
{
    struct stat info;
    assert_int_equal(stat(in_folder(name), &info), 0);
    return (size_t)info.st_size;
}

static void level_or_quality_changes_nothing(void **state)
{
    (void)state;
    tc_image *image;
    size_t size[4];
    tc_error err = {0};
    assert_int_equal(tc_image_create(&image, 200, 200, NULL), TC_OK);
    for (int i = 0; i < 200 * 200; i++) {
        for (int c = 0; c < 3; c++)
            image->rgba[4 * i + c] = 0.5f + 0.3f * sinf((float)(i % 200) * 0.07f * (float)(c + 1) + (float)i * 1e-4f);
        image->rgba[4 * i + 3] = 1;
    }
    const int level[] = {-1, 1, 0, 9};
    for (int i = 0; i < 4; i++) {
        must(tc_image_writer_save(writer, image, in_folder("a.png"), &(tc_image_encoding){.level = level[i]}, NULL, 0,
                                  NULL, &err),
             &err);
        size[i] = size_of("a.png");
        assert_true(i == 0 ? size[i] > 120000 && size[i] < 122000 : size[i] < size[i - 1]);
    }
    const int quality[] = {100, 0, 50, 1};
    for (int i = 0; i < 4; i++) {
        must(tc_image_writer_save(writer, image, in_folder("a.jpg"), &(tc_image_encoding){.quality = quality[i]}, NULL,
                                  0, NULL, &err),
             &err);
        size[i] = size_of("a.jpg");
        assert_true(i == 0 || size[i] < size[i - 1]);
    }
    tc_image_destroy(&image);
}

static void depth_is_rounded_or_moves_the_colours(void **state)
{
    (void)state;
    tc_image *image = noise(WIDTH, HEIGHT, false), *back;
    float *z = malloc(sizeof *z * WIDTH * HEIGHT), *got;
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        z[i] = i % 11 == 0 ? INFINITY : 1e5f + 1.0f / (float)(i + 3);
    for (int bits = 16; bits <= 32; bits += 16) {
        const tc_image_encoding plain = {.bits = bits}, deep = {.bits = bits, .depth = z};
        tc_error err = {0};
        must(tc_image_writer_save(writer, image, in_folder("a.exr"), &plain, NULL, 0, NULL, &err), &err);
        tc_image *flat = read_back("a.exr");
        must(tc_image_writer_read_depth(&back, &got, NULL, writer, in_folder("a.exr"), &err), &err);
        assert_null(got);
        tc_image_destroy(&back);
        must(tc_image_writer_save(writer, image, in_folder("a.exr"), &deep, NULL, 0, NULL, &err), &err);
        must(tc_image_writer_read_depth(&back, &got, NULL, writer, in_folder("a.exr"), &err), &err);
        assert_memory_equal(back->rgba, flat->rgba, (size_t)WIDTH * HEIGHT * 4 * sizeof(float));
        assert_non_null(got);
        assert_memory_equal(got, z, (size_t)WIDTH * HEIGHT * sizeof(float));
        tc_image_destroy(&back);
        free(got);
        back = read_back("a.exr");
        assert_memory_equal(back->rgba, flat->rgba, (size_t)WIDTH * HEIGHT * 4 * sizeof(float));
        tc_image_destroy(&back);
        tc_image_destroy(&flat);
    }
    free(z);
    tc_image_destroy(&image);
}

static void on_progress(void *user, const char *what, double fraction)
{
    double *last = user;
    (void)what;
    assert_true(fraction >= *last && fraction <= 1);
    *last = fraction;
}

static void count_warnings(void *user, tc_level level, const char *text)
{
    (void)text;
    *(double *)user += level == TC_WARNING ? 100 : 0;
}

static void progress_or_losses_are_not_told(void **state)
{
    (void)state;
    tc_image *image = noise(20, 3000, false);
    for (int i = 0; i < N_KIND; i++) {
        double last = 0, warnings = 0;
        const tc_log log = {NULL, on_progress, &last}, loud = {count_warnings, NULL, &warnings};
        stream_all(image, names[i], false, NULL, 0, &log, false);
        assert_true(last > 0.5);
        stream_all(image, names[i], false, NULL, 0, &loud, false);
        assert_true(warnings == (i == 3 ? 100 : 0)); /* transparency of JPEG */
    }
    tc_image_destroy(&image);
}

/* A pipe and a device take what is encoded, of every format. */
static void a_pipe_or_a_device_gets_something_else(void **state)
{
    (void)state;
    tc_image *image = noise(8, 8, false);
    for (int i = 0; i < N_KIND; i++) {
        tc_error err = {0};
        void *data;
        size_t n;
        uint8_t bytes[65536];
        stream_all(image, names[i], false, NULL, 0, NULL, false);
        must(tc_file_read(&data, &n, in_folder(names[i]), &err), &err);
        unlink(in_folder(names[i]));
        assert_int_equal(mkfifo(in_folder(names[i]), 0600), 0);
        int fd = open(in_folder(names[i]), O_RDWR); /* so that nobody waits */
        stream_all(image, names[i], false, NULL, 0, NULL, false);
        assert_int_equal(read(fd, bytes, sizeof bytes), n);
        if (i != 2) /* TIFF has the time in it */
            assert_memory_equal(bytes, data, n);
        close(fd);
        free(data);
        unlink(in_folder(names[i]));
        assert_int_equal(symlink("/dev/full", in_folder(names[i])), 0);
        tc_image_stream *stream = opened(names[i], image, false, NULL, 0, NULL, false);
        tc_status status = tc_image_stream_rows(stream, image->rgba, 8, &err);
        status = status == TC_OK ? tc_image_stream_close(&stream, true, &err) : status;
        assert_int_equal(status, TC_E_FILE);
        must_say(&err, "free some space");
        (void)tc_image_stream_close(&stream, false, NULL);
        files(true);
    }
    tc_image_destroy(&image);
}

/* In portions: the limits of the tests below hold for what goes to the helper, too. */
static tc_status stream_tens(const tc_image *image, const char *name, tc_error *err)
{
    tc_image_stream *stream = NULL;
    tc_status status =
        tc_image_stream_open(&stream, in_folder(name), image->width, image->height, false, NULL, NULL, 0, NULL, err);
    for (int y = 0; y < image->height && status == TC_OK; y += 10)
        status = tc_image_stream_rows(stream, image->rgba + 4 * (size_t)image->width * (size_t)y, 10, err);
    if (status == TC_OK)
        return tc_image_stream_close(&stream, true, err);
    (void)tc_image_stream_close(&stream, false, NULL);
    return status;
}

/* In a child: all formats where only so many bytes may be written; 0 as it should be. */
static int refused_of_all(bool whole)
{
    tc_image *image = noise(400, 400, false); /* 200 KB and more in each format */
    int bad = 0;
    for (int i = 0; i < N_KIND && !bad; i++) {
        tc_error err = {0};
        tc_status status = whole ? tc_image_write(image, in_folder(names[i]), NULL, 0, NULL, &err)
                                 : stream_tens(image, names[i], &err);
        bad = status != TC_E_FILE || !strstr(err.text, "free some space") || !strstr(err.text, names[i]) ||
              files(false) != 0;
        if (bad)
            fprintf(stderr, "%s: status %d, \"%s\", %d files\n", names[i], (int)status, err.text, files(false));
    }
    tc_image_destroy(&image);
    return bad;
}

static int child_of(int (*work)(void))
{
    int how;
    pid_t child = fork();
    if (child == 0)
        _exit(work());
    assert_int_equal(waitpid(child, &how, 0), child);
    assert_true(WIFEXITED(how));
    return WEXITSTATUS(how);
}

static int with_a_limit(void)
{
    struct rlimit tiny;
    getrlimit(RLIMIT_FSIZE, &tiny);
    tiny.rlim_cur = 100000;
    signal(SIGXFSZ, SIG_IGN);
    return setrlimit(RLIMIT_FSIZE, &tiny) != 0 ? 1 : refused_of_all(false);
}

static void a_file_that_may_not_grow_is_not_told(void **state)
{
    (void)state;
    assert_int_equal(child_of(with_a_limit), 0);
}

static int on_a_small_disk(void)
{
    if (unshare(CLONE_NEWNS) != 0 && unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0)
        return 77;
    if (mount(NULL, "/", NULL, MS_REC | MS_PRIVATE, NULL) != 0)
        return 77;
    if (mount("none", folder, "tmpfs", 0, "size=128k") != 0)
        return 77;
    return refused_of_all(true);
}

static void a_full_disk_leaves_half_a_picture_or_is_not_told(void **state)
{
    (void)state;
    int how = child_of(on_a_small_disk);
    if (how == 77)
        skip(); /* no right to mount */
    assert_int_equal(how, 0);
}

/* What is left out at the end of the file, where libraries only close: every size of disk about that of the file. */
static int on_a_disk_of_every_size(void)
{
    tc_image *image = noise(100, 100, false);
    size_t n[N_KIND];
    for (int i = 0; i < N_KIND; i++) {
        if (stream_tens(image, names[i], NULL) != TC_OK)
            return 2;
        n[i] = size_of(names[i]);
    }
    files(true);
    for (int i = 0; i < N_KIND; i++)
        for (int k = 0; k < 3; k++) {
            static const int off[] = {0, 1, 60};
            const int less = off[k];
            /* the helper starts with the limit */
            struct rlimit limit, before;
            getrlimit(RLIMIT_FSIZE, &before);
            limit = before;
            limit.rlim_cur = n[i] - (size_t)less;
            tc_error err = {0};
            signal(SIGXFSZ, SIG_IGN);
            setrlimit(RLIMIT_FSIZE, &limit);
            tc_status status = stream_tens(image, names[i], &err);
            setrlimit(RLIMIT_FSIZE, &before);
            if ((status == TC_OK) != (less == 0) || files(false) != (less == 0)) {
                fprintf(stderr, "%s without its last %d of %zu bytes: %d %s\n", names[i], less, n[i], (int)status,
                        err.text);
                return 3;
            }
            files(true);
        }
    tc_image_destroy(&image);
    return 0;
}

static void the_last_bytes_are_lost_silently(void **state)
{
    (void)state;
    assert_int_equal(child_of(on_a_disk_of_every_size), 0);
}

static void a_killed_stream_leaves_half_a_picture(void **state)
{
    (void)state;
    tc_image *image = noise(WIDTH, HEIGHT, false);
    for (int i = 0; i < N_KIND; i++) {
        int ready[2];
        char c;
        assert_int_equal(pipe(ready), 0);
        pid_t child = fork();
        if (child == 0) {
            tc_image_stream *stream;
            if (tc_image_stream_open(&stream, in_folder(names[i]), WIDTH, HEIGHT, false, NULL, NULL, 0, NULL, NULL) !=
                    TC_OK ||
                tc_image_stream_rows(stream, image->rgba, HEIGHT, NULL) != TC_OK || write(ready[1], "", 1) != 1)
                _exit(1);
            pause();
        }
        assert_int_equal(read(ready[0], &c, 1), 1);
        kill(child, SIGKILL);
        assert_int_equal(waitpid(child, NULL, 0), child);
        close(ready[0]);
        close(ready[1]);
        int fd = open(folder, O_TMPFILE | O_RDWR, 0600);
        assert_int_equal(files(false), fd < 0);
        close(fd);
        stream_all(image, names[i], false, NULL, 0, NULL, false);
        assert_int_equal(files(true), 1);
    }
    tc_image_destroy(&image);
}

typedef struct job {
    int number, bad;
    const tc_image *image;
    char path[N_KIND][96];
} job;

static void *write_in_a_thread(void *argument)
{
    job *j = argument;
    tc_image_writer *own = NULL;
    j->bad = tc_image_writer_create(&own, NULL) != TC_OK;
    for (int round = 0; round < 3 && !j->bad; round++)
        for (int i = 0; i < N_KIND && !j->bad; i++) {
            tc_error err = {0};
            const int kind = (i + j->number) % N_KIND;
            j->bad = tc_image_writer_save(own, j->image, j->path[kind], NULL, NULL, 0, NULL, &err) != TC_OK;
            if (j->bad)
                fprintf(stderr, "%s\n", err.text);
        }
    tc_image_writer_destroy(&own);
    return NULL;
}

/* Beside them this thread makes pictures, and writes rows of one. */
static void writers_of_two_threads_mix(void **state)
{
    (void)state;
    enum { N = 2 };
    job jobs[N];
    pthread_t thread[N];
    tc_image *image[N];
    for (int k = 0; k < N; k++) {
        image[k] = noise(150 + 20 * k, 100, k);
        jobs[k] = (job){.number = k, .image = image[k]};
        for (int i = 0; i < N_KIND; i++)
            snprintf(jobs[k].path[i], sizeof jobs[k].path[i], "%s/%d%s", folder, k, names[i]);
        assert_int_equal(pthread_create(&thread[k], NULL, write_in_a_thread, &jobs[k]), 0);
    }
    tc_image *mine = noise(64, 2000, false);
    for (int i = 0; i < N_KIND; i++)
        stream_all(mine, names[i], false, NULL, 0, NULL, true);
    for (int k = 0; k < N; k++) {
        pthread_join(thread[k], NULL);
        assert_int_equal(jobs[k].bad, 0);
        for (int i = 1; i < 3; i++) { /* EXR and TIFF lose nothing */
            tc_error err = {0};
            tc_image *back;
            must(tc_image_writer_read(&back, NULL, writer, jobs[k].path[i], &err), &err);
            assert_int_equal(back->width, image[k]->width);
            assert_memory_equal(back->rgba, image[k]->rgba, (size_t)back->width * 100 * 4 * sizeof(float));
            tc_image_destroy(&back);
        }
        tc_image_destroy(&image[k]);
    }
    tc_image_destroy(&mine);
    assert_int_equal(files(false), (N + 1) * N_KIND);
}

#define TEST(f) cmocka_unit_test_teardown(f, teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(a_stream_is_another_picture_than_a_whole_one),
        TEST(what_is_not_opaque_is_not_laid_over_black),
        TEST(a_stream_that_was_not_ended_leaves_a_file),
        TEST(a_row_that_is_not_finite_is_written),
        TEST(what_no_format_has_is_not_refused_in_words),
        TEST(level_or_quality_changes_nothing),
        TEST(depth_is_rounded_or_moves_the_colours),
        TEST(progress_or_losses_are_not_told),
        TEST(a_pipe_or_a_device_gets_something_else),
        TEST(a_file_that_may_not_grow_is_not_told),
        TEST(a_full_disk_leaves_half_a_picture_or_is_not_told),
        TEST(the_last_bytes_are_lost_silently),
        TEST(a_killed_stream_leaves_half_a_picture),
        TEST(writers_of_two_threads_mix),
    };
    return cmocka_run_group_tests(tests, group_setup, group_teardown);
}
