/* Videos of finished pictures (cli/batch/video.h): with a false ffmpeg, which writes down what it gets, and with the
 * real one where it is installed. */
#define _GNU_SOURCE
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "cli/batch/video.h"

#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

static char folder[64], path[128], path_before[8192];
static const char *const nasty[] = {"a b.png",   "it's.png",       "say \"x\".png", "-i.png",
                                    "100%d.png", "two\nlines.png", "$(x);.png",     "\xe4.png"};
enum { N_NASTY = 8 };

static const char *in_folder(const char *name)
{
    static char text[16][192];
    static int at;
    char *out = text[at++ % 16];
    snprintf(out, 192, "%s/%s", folder, name);
    return out;
}

static int begin(void **state)
{
    (void)state;
    strcpy(folder, "/tmp/tetcast-video-XXXXXX");
    snprintf(path_before, sizeof path_before, "%s", getenv("PATH"));
    if (!mkdtemp(folder))
        return -1;
    snprintf(path, sizeof path, "%s", in_folder("out.mp4"));
    return 0;
}

static int end(void **state)
{
    (void)state;
    char command[128];
    setenv("PATH", path_before, 1);
    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    return system(command);
}

/* A picture of one colour (straight alpha), or of noise where red is negative. */
static void picture(const char *file, int width, int height, float red, float green, float blue, float alpha)
{
    tc_image *image;
    tc_error err = {0};
    assert_int_equal(tc_image_create(&image, width, height, &err), TC_OK);
    unsigned seed = 1;
    for (size_t i = 0; i < (size_t)width * (size_t)height; i++) {
        const float colour[4] = {red * alpha, green * alpha, blue * alpha, alpha};
        for (int k = 0; k < 4; k++) {
            seed = seed * 1664525u + 1013904223u;
            image->rgba[4 * i + (size_t)k] = red < 0 && k < 3 ? (float)(seed >> 8) / 16777216.0f : colour[k];
        }
    }
    if (tc_image_write(image, file, NULL, 0, NULL, &err) != TC_OK)
        fail_msg("%s", err.text);
    tc_image_destroy(&image);
}

static size_t size_of(const char *file)
{
    struct stat info;
    return stat(file, &info) == 0 ? (size_t)info.st_size : 0;
}

/* All of a file; the caller frees it. */
static char *content(const char *file, size_t *bytes)
{
    FILE *from = fopen(file, "rb");
    assert_non_null(from);
    char *text = malloc(size_of(file) + 1);
    assert_non_null(text);
    *bytes = fread(text, 1, size_of(file), from);
    text[*bytes] = 0;
    fclose(from);
    return text;
}

/* A false ffmpeg in PATH: `script` is run with the last argument, without "file:", in $out. */
static void false_ffmpeg(const char *script)
{
    char search[8400];
    mkdir(in_folder("bin"), 0777);
    FILE *file = fopen(in_folder("bin/ffmpeg"), "w");
    assert_non_null(file);
    fprintf(file, "#!/bin/sh\ncd '%s'\nfor out; do printf '%%s\\n' \"$out\"; done >arguments\nout=${out#file:}\n%s\n",
            folder, script);
    fclose(file);
    chmod(in_folder("bin/ffmpeg"), 0755);
    snprintf(search, sizeof search, "%s:%s", in_folder("bin"), path_before);
    setenv("PATH", search, 1);
}

/* Is there nothing but what was there before beside the video? */
static bool is_nothing_left(void)
{
    return access(path, F_OK) != 0 && access(in_folder(".out.mp4.part"), F_OK) != 0;
}

static void a_name_of_a_picture_is_read_by_ffmpeg(void **state)
{
    (void)state;
    const char *frame[N_NASTY];
    tc_error err = {0};
    false_ffmpeg("cat >got; echo video >\"$out\"");
    FILE *all = fopen(in_folder("all"), "wb");
    for (size_t i = 0; i < N_NASTY; i++) {
        frame[i] = strdup(in_folder(nasty[i]));
        picture(frame[i], 8, 6, 0.1f * (float)i, 0.5f, 0.5f, 1);
        size_t n;
        char *text = content(frame[i], &n);
        assert_int_equal(fwrite(text, 1, n, all), n);
        free(text);
    }
    fclose(all);
    char *odd = strdup(in_folder("-y: 'o' %d.mp4"));
    if (tc_video_make(odd, frame, N_NASTY, &(tc_video_options){.fps = 23.976, .quality = 50}, &err) != TC_OK)
        fail_msg("%s", err.text);
    size_t n, want;
    char *got = content(in_folder("got"), &n), *sent = content(in_folder("all"), &want);
    assert_int_equal(n, want);
    assert_memory_equal(got, sent, n);
    free(got);
    free(sent);
    got = content(in_folder("arguments"), &n);
    static const char *const has[] = {"\nimage2pipe\n", "\n23976/1000\n", "\nlibx264\n",
                                      "\n26\n",         "\n+bitexact\n",  "\n-map_metadata\n-1\n",
                                      "\npipe:0\n",     "\n-nostdin\n",   "yuv420p\n"};
    for (size_t i = 0; i < sizeof has / sizeof *has; i++)
        if (!strstr(got, has[i]))
            fail_msg("no %s in %s", has[i], got);
    assert_null(strstr(got, "a b.png"));
    assert_null(strstr(got, "overlay"));
    assert_null(strstr(got, "pad="));
    free(got);
    got = content(odd, &n);
    assert_string_equal(got, "video\n");
    free(got);
    free(odd);
    for (size_t i = 0; i < N_NASTY; i++)
        free((char *)frame[i]);
}

static void a_missing_ffmpeg_is_not_told(void **state)
{
    (void)state;
    tc_error err = {0};
    char why[256];
    const char *const frame[] = {in_folder("a.png")};
    picture(frame[0], 8, 8, 1, 0, 0, 1);
    false_ffmpeg("cat >/dev/null");
    assert_true(tc_video_is_possible(NULL, 0));
    mkdir(in_folder("empty"), 0777);
    setenv("PATH", in_folder("empty"), 1);
    assert_false(tc_video_is_possible(why, sizeof why));
    assert_non_null(strstr(why, "install it"));
    assert_int_equal(tc_video_make(path, frame, 1, NULL, &err), TC_E_WORKER);
    assert_non_null(strstr(err.text, path));
    assert_non_null(strstr(err.text, "apt install ffmpeg"));
    assert_true(is_nothing_left());
    assert_true(size_of(frame[0]) > 0);
}

static void a_failed_ffmpeg_leaves_half_a_video_or_does_not_say_why(void **state)
{
    (void)state;
    static const struct {
        const char *script, *says;
    } row[] = {
        {"cat >/dev/null; echo half >\"$out\"; echo first >&2; echo 'no such encoder' >&2; exit 1",
         "failed: no such encoder;"},
        {"cat >/dev/null; echo half >\"$out\"; kill -9 $$", "signal 9"},
        {"echo half >\"$out\"; echo 'enough of it' >&2; exit 0", "enough of it"}, /* takes no frame */
        {"cat >/dev/null; exit 0", "did not say why"},                            /* writes nothing */
    };
    const char *frame[8];
    for (size_t i = 0; i < 8; i++)
        frame[i] = i ? frame[0] : strdup(in_folder("noise.png"));
    picture(frame[0], 400, 300, -1, 0, 0, 1);
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        tc_error err = {0};
        false_ffmpeg(row[i].script);
        assert_int_equal(tc_video_make(path, frame, 8, NULL, &err), TC_E_WORKER);
        if (!strstr(err.text, row[i].says) || !strstr(err.text, path) || strchr(err.text, '\n') ||
            strstr(err.text, "first"))
            fail_msg("%s", err.text);
        assert_true(is_nothing_left());
    }
    free((char *)frame[0]);
}

typedef struct stop_at {
    size_t frame;
    bool last_seen;
} stop_at;

static bool go_on(void *user, size_t frame, size_t n)
{
    stop_at *at = user;
    at->last_seen = frame == n;
    return frame < at->frame;
}

static void a_stopped_run_goes_on_or_leaves_half_a_video(void **state)
{
    (void)state;
    const char *frame[6];
    for (size_t i = 0; i < 6; i++)
        frame[i] = in_folder("a.png");
    picture(frame[0], 8, 8, 0, 1, 0, 1);
    false_ffmpeg("cat >got; echo half >\"$out\"; sleep 30");
    for (int late = 0; late < 2; late++) {
        tc_error err = {0};
        stop_at at = {.frame = late ? 6 : 3};
        assert_int_equal(tc_video_make(path, frame, 6, &(tc_video_options){.go_on = go_on, .user = &at}, &err),
                         TC_E_CANCEL);
        assert_int_equal(at.last_seen, late);
        assert_true(is_nothing_left());
    }
}

static void a_picture_that_does_not_fit_is_taken(void **state)
{
    (void)state;
    size_t n;
    picture(in_folder("a.png"), 8, 8, 0, 1, 0, 1);
    picture(in_folder("wide.png"), 9, 8, 0, 1, 0, 1);
    char *whole = content(in_folder("a.png"), &n);
    FILE *file = fopen(in_folder("cut.png"), "wb");
    fwrite(whole, 1, n - 5, file);
    fclose(file);
    file = fopen(in_folder("text.png"), "wb");
    fputs("no picture", file);
    fclose(file);
    free(whole);
    false_ffmpeg("cat >/dev/null; echo video >\"$out\"");
    static const struct {
        const char *name, *says;
    } row[] = {{"wide.png", "8x8"},
               {"cut.png", "is cut"},
               {"text.png", "neither a PNG"},
               {"none.png", "cannot be read"},
               {"bin", "cannot be read"}};
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        tc_error err = {0};
        const char *const frame[] = {in_folder("a.png"), in_folder(row[i].name)};
        assert_int_equal(tc_video_make(path, frame, 2, NULL, &err), TC_E_FILE);
        assert_non_null(strstr(err.text, frame[1]));
        assert_non_null(strstr(err.text, row[i].says));
        assert_true(is_nothing_left());
    }
}

static void a_wrong_request_is_taken(void **state)
{
    (void)state;
    static const char *const good[] = {"a.mp4", "x/a.MOV", "a.b.webm", "a.gif"}, *const bad[] = {"a.avi", ".mp4",
                                                                                                 "x/.mp4", "mp4",
                                                                                                 "a.png"};
    for (size_t i = 0; i < 4; i++)
        assert_true(tc_video_is_name(good[i]));
    for (size_t i = 0; i < 5; i++)
        assert_false(tc_video_is_name(bad[i]));
    tc_error err = {0};
    const char *const frame[] = {in_folder("a.png")};
    picture(frame[0], 8, 8, 0, 1, 0, 1);
    false_ffmpeg("cat >/dev/null; echo video >\"$out\"");
    assert_int_equal(tc_video_make("a.avi", frame, 1, NULL, &err), TC_E_ARG);
    assert_int_equal(tc_video_make(path, frame, 0, NULL, &err), TC_E_ARG);
    assert_int_equal(tc_video_make(path, frame, 1, &(tc_video_options){.fps = NAN}, &err), TC_E_ARG);
    assert_int_equal(tc_video_make(path, frame, 1, &(tc_video_options){.fps = 0.001}, &err), TC_E_ARG);
    assert_int_equal(tc_video_make(path, frame, 1, &(tc_video_options){.quality = 101}, &err), TC_E_ARG);
    assert_int_equal(tc_video_make(in_folder("none/a.mp4"), frame, 1, NULL, &err), TC_E_FILE);
    assert_non_null(strstr(err.text, "make its folder first"));
    mkdir(path, 0777);
    assert_int_equal(tc_video_make(path, frame, 1, NULL, &err), TC_E_FILE);
    assert_non_null(strstr(err.text, "not a folder"));
    assert_int_equal(rmdir(path), 0);
}

static void two_processes_garble_one_video_or_a_killed_one_blocks_it(void **state)
{
    (void)state;
    tc_error err = {0};
    const char *const frame[] = {in_folder("a.png")};
    picture(frame[0], 8, 8, 0, 1, 0, 1);
    false_ffmpeg("cat >/dev/null; echo video >\"$out\"");
    int other = open(in_folder(".out.mp4.part"), O_RDWR | O_CREAT, 0666);
    assert_int_equal(flock(other, LOCK_EX), 0);
    assert_int_equal(tc_video_make(path, frame, 1, NULL, &err), TC_E_FILE);
    assert_non_null(strstr(err.text, "another process"));
    assert_int_equal(access(in_folder(".out.mp4.part"), F_OK), 0);
    assert_int_equal(write(other, "half a long video", 17), 17);
    close(other);
    assert_int_equal(tc_video_make(path, frame, 1, NULL, &err), TC_OK);
    assert_int_equal(size_of(path), 6);
    assert_int_not_equal(access(in_folder(".out.mp4.part"), F_OK), 0);
}

/* With the real one. */

static bool is_installed(void)
{
    return system("ffmpeg -version >/dev/null 2>&1 && ffprobe -version >/dev/null 2>&1") == 0;
}

/* Frames, size and rate of a video: "N,WxH,R". */
static const char *probe(const char *file)
{
    static char text[128];
    char command[512];
    int width = 0, height = 0, n = 0;
    char rate[32] = "";
    snprintf(command, sizeof command,
             "ffprobe -v error -count_frames -select_streams v:0 -show_entries "
             "stream=width,height,r_frame_rate,nb_read_frames "
             "-of csv=p=0 '%s'",
             file);
    FILE *from = popen(command, "r");
    if (fscanf(from, "%d,%d,%31[^,],%d", &width, &height, rate, &n) != 4)
        width = -1;
    pclose(from);
    snprintf(text, sizeof text, "%d,%dx%d,%s", n, width, height, rate);
    return text;
}

/* The pixel in the middle of a frame, as ffmpeg decodes it to 8 bit RGBA. */
static void middle(unsigned char rgba[4], const char *file, int frame, int width, int height)
{
    char command[512];
    const char *decoder = strstr(file, ".webm") ? "-c:v libvpx-vp9" : ""; /* the built-in one drops transparency */
    snprintf(command, sizeof command, "ffmpeg -v error %s -i '%s' -f rawvideo -pix_fmt rgba - </dev/null", decoder,
             file);
    FILE *from = popen(command, "r");
    size_t bytes = (size_t)width * (size_t)height * 4;
    unsigned char *pixel = malloc(bytes);
    for (int i = 0; i <= frame; i++)
        assert_int_equal(fread(pixel, 1, bytes, from), bytes);
    while (fgetc(from) != EOF)
        ;
    pclose(from);
    memcpy(rgba, pixel + 4 * ((size_t)(height / 2) * (size_t)width + (size_t)(width / 2)), 4);
    free(pixel);
}

static void assert_near(const unsigned char *got, int red, int green, int blue, int alpha)
{
    const int want[4] = {red, green, blue, alpha};
    for (int k = 0; k < 4; k++)
        if (abs(got[k] - want[k]) > 4)
            fail_msg("%d %d %d %d instead of %d %d %d %d", got[0], got[1], got[2], got[3], red, green, blue, alpha);
}

static void a_video_has_other_frames_than_its_pictures(void **state)
{
    (void)state;
    if (!is_installed())
        skip();
    static const struct {
        const char *name, *probed, *clear;
        int width, height;
    } row[] = {{"a.mp4", "6,34x18,25/2", "7,34x18,25/2", 34, 18},
               {"a.mov", "6,34x18,25/2", "7,34x18,25/2", 34, 18},
               {"a.webm", "6,34x18,25/2", "7,34x18,25/2", 34, 18},
               {"a.gif", "6,33x17,25/2", "7,33x17,25/2", 33, 17}};
    const char *frame[7];
    for (int i = 0; i < 7; i++) {
        char name[32];
        snprintf(name, sizeof name, "f %d.png", i);
        frame[i] = strdup(in_folder(name));
        picture(frame[i], 33, 17, i % 3 == 0, i % 3 == 1, i % 3 == 2,
                i < 6 ? 1 : 0.5f); /* red, green, blue; clear red at last */
    }
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        tc_error err = {0};
        unsigned char rgba[4];
        const char *file = in_folder(row[i].name);
        if (tc_video_make(file, frame, 6, &(tc_video_options){.fps = 12.5, .quality = 100}, &err) != TC_OK)
            fail_msg("%s", err.text);
        assert_string_equal(probe(file), row[i].probed);
        middle(rgba, file, 0, row[i].width, row[i].height);
        assert_near(rgba, 255, 0, 0, 255);
        middle(rgba, file, 4, row[i].width, row[i].height);
        assert_near(rgba, 0, 255, 0, 255);
        size_t n, again;
        char *first = content(file, &n);
        assert_int_equal(tc_video_make(file, frame, 6, &(tc_video_options){.fps = 12.5, .quality = 100}, &err), TC_OK);
        char *second = content(file, &again);
        assert_int_equal(n, again);
        assert_memory_equal(first, second, n);
        free(first);
        free(second);
        if (tc_video_make(file, frame, 7, &(tc_video_options){.fps = 12.5, .quality = 100}, &err) != TC_OK)
            fail_msg("%s", err.text);
        assert_string_equal(probe(file), row[i].clear);
        middle(rgba, file, 6, row[i].width, row[i].height);
        if (!strcmp(row[i].name, "a.webm"))
            assert_near(rgba, 255, 0, 0, 128);
        else
            assert_near(rgba, 255, 128, 128, 255);
        middle(rgba, file, 1, row[i].width, row[i].height);
        assert_near(rgba, 0, 255, 0, 255);
    }
    for (int i = 0; i < 7; i++)
        free((char *)frame[i]);
}

static void a_damaged_picture_is_skipped(void **state)
{
    (void)state;
    if (!is_installed())
        skip();
    const char *frame[3] = {in_folder("a.png"), in_folder("bad.png"), in_folder("a.png")};
    picture(frame[0], 64, 64, -1, 0, 0, 1);
    size_t n;
    char *text = content(frame[0], &n);
    text[n / 2] ^= 0x10;
    FILE *file = fopen(frame[1], "wb");
    fwrite(text, 1, n, file);
    fclose(file);
    free(text);
    tc_error err = {0};
    assert_int_equal(tc_video_make(path, frame, 3, NULL, &err), TC_E_WORKER);
    assert_non_null(strstr(err.text, "ffmpeg failed: "));
    assert_true(is_nothing_left());
}

static void pictures_of_jpeg_are_refused(void **state)
{
    (void)state;
    if (!is_installed())
        skip();
    char command[400];
    tc_error err = {0};
    const char *const frame[] = {in_folder("1.jpg"), in_folder("2.jpg")}, *const mixed[] = {in_folder("1.jpg"),
                                                                                            in_folder("a.png")};
    picture(in_folder("a.png"), 20, 10, 0, 0, 1, 1);
    for (int i = 0; i < 2; i++) {
        snprintf(command, sizeof command, "ffmpeg -v error -i '%s' '%s' </dev/null", in_folder("a.png"), frame[i]);
        assert_int_equal(system(command), 0);
    }
    if (tc_video_make(path, frame, 2, NULL, &err) != TC_OK)
        fail_msg("%s", err.text);
    assert_string_equal(probe(path), "2,20x10,24/1");
    assert_int_equal(tc_video_make(path, mixed, 2, NULL, &err), TC_E_FILE);
    assert_non_null(strstr(err.text, "JPEG"));
}

#define CASE(name) cmocka_unit_test_setup_teardown(name, begin, end)

int main(void)
{
    const struct CMUnitTest test[] = {
        CASE(a_name_of_a_picture_is_read_by_ffmpeg),
        CASE(a_missing_ffmpeg_is_not_told),
        CASE(a_failed_ffmpeg_leaves_half_a_video_or_does_not_say_why),
        CASE(a_stopped_run_goes_on_or_leaves_half_a_video),
        CASE(a_picture_that_does_not_fit_is_taken),
        CASE(a_wrong_request_is_taken),
        CASE(two_processes_garble_one_video_or_a_killed_one_blocks_it),
        CASE(a_video_has_other_frames_than_its_pictures),
        CASE(a_damaged_picture_is_skipped),
        CASE(pictures_of_jpeg_are_refused),
    };
    return cmocka_run_group_tests(test, NULL, NULL);
}
