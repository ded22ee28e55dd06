/* What a frame's pixels depend on (cli/batch/digest.h). */
#define _GNU_SOURCE
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "cli/batch/batch_options.h"
#include "cli/batch/digest.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static char folder[64];

static const char *in_folder(const char *name)
{
    static char text[8][192];
    static int at;
    char *out = text[at++ % 8];
    snprintf(out, 192, "%s/%s", folder, name);
    return out;
}

/* A file whose last change was so many seconds after a fixed moment. */
static void put(const char *name, const char *text, int seconds)
{
    FILE *stream = fopen(in_folder(name), "w");
    assert_non_null(stream);
    fputs(text, stream);
    fclose(stream);
    const struct timespec when[2] = {{1700000000 + seconds, 0}, {1700000000 + seconds, 0}};
    assert_int_equal(utimensat(AT_FDCWD, in_folder(name), when, 0), 0);
}

/* Files that changed just now are not believed. */
static void settle(void)
{
    usleep(100000);
}

static int begin(void **state)
{
    (void)state;
    strcpy(folder, "/tmp/tetcast-digest-XXXXXX");
    return mkdtemp(folder) ? 0 : -1;
}

static int end(void **state)
{
    (void)state;
    char command[128];
    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    return system(command);
}

static const char *identity(const char *path)
{
    static char text[8][TC_IDENTITY];
    static int at;
    char *out = text[at++ % 8];
    memset(out, 'x', TC_IDENTITY - 1);
    tc_identity_make(out, TC_IDENTITY, path);
    return out;
}

static void a_file_that_changed_is_another(void **state)
{
    (void)state;
    put("a.vtu", "one", 0);
    const char *before = identity(in_folder("a.vtu"));
    assert_true(*before);
    assert_null(strchr(before, '/')); /* its folder may have moved */
    assert_string_equal(identity(in_folder("a.vtu")), before);
    put("a.vtu", "two", 1);
    assert_string_not_equal(identity(in_folder("a.vtu")), before);
    put("a.vtu", "three", 0);
    assert_string_not_equal(identity(in_folder("a.vtu")), before);
    put("a.vtu", "one", 0);
    assert_string_equal(identity(in_folder("a.vtu")), before);
    put("b.vtu", "one", 0);
    assert_string_not_equal(identity(in_folder("b.vtu")), before);
    assert_string_equal(identity(in_folder("gone.vtu")), "");
    assert_string_equal(identity("synth:ball:300"), "synth:ball:300");
}

static void a_dataset_of_files_is_another_when_one_of_them_is(void **state)
{
    (void)state;
    static const char list[] = "<VTKFile type=\"Collection\"><Collection><DataSet timestep=\"0\" file=\"a.vtu\"/>"
                               "</Collection></VTKFile>";
    put("a.vtu", "one", 0);
    put("run.pvd", list, 0);
    settle();
    const char *before = identity(in_folder("run.pvd"));
    assert_true(*before);
    assert_string_equal(identity(in_folder("run.pvd")), before);
    put("picture.png", "a picture that is made meanwhile", 5);
    settle();
    assert_string_equal(identity(in_folder("run.pvd")), before);
    put("a.vtu", "one", 1);
    settle();
    assert_string_not_equal(identity(in_folder("run.pvd")), before);
}

static void a_dataset_that_cannot_be_told_has_no_identity(void **state)
{
    (void)state;
    put("far.pvd",
        "<VTKFile type=\"Collection\"><Collection><DataSet timestep=\"0\" "
        "file=\"../away/a.vtu\"/></Collection></VTKFile>",
        0);
    settle();
    assert_string_equal(identity(in_folder("far.pvd")), "");
}

static void a_digest_is_that_of_the_values(void **state)
{
    (void)state;
    char a[17], b[17];
    tc_digest_make(a, json_pack("{s:i,s:f}", "one", 1, "two", 0.1));
    tc_digest_make(b, json_pack("{s:f,s:i}", "two", 0.1, "one", 1));
    assert_int_equal(strlen(a), 16);
    assert_int_equal(strspn(a, "0123456789abcdef"), 16);
    assert_string_equal(a, b);
    tc_digest_make(b, json_pack("{s:i,s:f}", "one", 1, "two", 0.1 + 1e-16)); /* another double */
    assert_string_not_equal(a, b);
    tc_digest_make(b, json_pack("{s:i,s:f}", "one", 1, "three", 0.1));
    assert_string_not_equal(a, b);
    tc_digest_make(a, json_object()); /* FNV-1a of "{}" */
    assert_string_equal(a, "08f44b07b5901a25");
}

/* The digest of what a command line says of pictures. */
static const char *options(int argc, const char **argv)
{
    static char text[8][17];
    static int at;
    char *out = text[at++ % 8];
    tc_talk talk;
    tc_batch_command command;
    tc_talk_init(&talk);
    assert_int_equal(tc_batch_command_take(&command, NULL, &talk, argc, (char **)(uintptr_t)argv), -1);
    tc_digest_make(out, tc_digest_options(&command.picture));
    tc_batch_command_finish(&command);
    return out;
}
#define OPTIONS(...) options(sizeof((const char *[]){__VA_ARGS__}) / sizeof(char *), (const char *[]){__VA_ARGS__})

static void what_is_seen_counts(void **state)
{
    (void)state;
    const char *plain = OPTIONS("batch", "synth:ball");
    static const char *const seen[][2] = {{"--color-map", "Viridis"}, {"--opacity", "0:0,1:0.5"}, {"--size", "64x48"},
                                          {"--shade", "vertex"},      {"--azimuth", "30"},        {"--title", "{time}"},
                                          {"--samples", "4"},         {"--background", "1,1,1"},  {"--bits", "16"}};
    for (size_t i = 0; i < sizeof seen / sizeof *seen; i++) {
        const char *with = OPTIONS("batch", "synth:ball", seen[i][0], seen[i][1]);
        assert_string_not_equal(with, plain);
        assert_string_equal(OPTIONS("batch", "synth:ball", seen[i][0], seen[i][1]), with);
    }
    assert_string_not_equal(OPTIONS("batch", "synth:ball", "--azimuth", "30"),
                            OPTIONS("batch", "synth:ball", "--azimuth", "31"));
    assert_string_not_equal(OPTIONS("batch", "synth:ball", "--azimuth", "30"),
                            OPTIONS("batch", "synth:ball", "--elevation", "30"));
}

static void where_when_and_how_fast_do_not(void **state)
{
    (void)state;
    const char *plain = OPTIONS("batch", "synth:ball");
    static const char *const apart[][2] = {
        {"--threads", "2"},          {"--shard", "1/3"}, {"--frames", "0:3"}, {"--memory", "4G"}, {"--step", "1"},
        {"--output", "a{step}.png"}, {"--fps", "5"},     {"--resume", NULL},  {"--quiet", NULL},  {"--json", NULL}};
    for (size_t i = 0; i < sizeof apart / sizeof *apart; i++) {
        const char *argv[] = {"batch", "synth:ball", apart[i][0], apart[i][1]};
        assert_string_equal(options(apart[i][1] ? 4 : 3, argv), plain);
    }
}

static void a_file_that_an_option_names_counts_with_its_state(void **state)
{
    (void)state;
    put("map.json", "[]", 0);
    char path[192];
    snprintf(path, sizeof path, "%s", in_folder("map.json"));
    const char *before = OPTIONS("batch", "synth:ball", "--color-map", path);
    assert_string_equal(OPTIONS("batch", "synth:ball", "--color-map", path), before);
    put("map.json", "[ ]", 0);
    assert_string_not_equal(OPTIONS("batch", "synth:ball", "--color-map", path), before);
    put("x.obj", "v 0 0 0\n", 0);
    char half[208], third[208];
    snprintf(half, sizeof half, "%s,0.5", in_folder("x.obj"));
    snprintf(third, sizeof third, "%s,0.3", in_folder("x.obj"));
    before = OPTIONS("batch", "synth:ball", "--geometry", half);
    assert_string_not_equal(OPTIONS("batch", "synth:ball", "--geometry", third), before);
    put("x.obj", "v 0 0 0\n", 1);
    assert_string_not_equal(OPTIONS("batch", "synth:ball", "--geometry", half), before);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_file_that_changed_is_another),
        cmocka_unit_test(a_dataset_of_files_is_another_when_one_of_them_is),
        cmocka_unit_test(a_dataset_that_cannot_be_told_has_no_identity),
        cmocka_unit_test(a_digest_is_that_of_the_values),
        cmocka_unit_test(what_is_seen_counts),
        cmocka_unit_test(where_when_and_how_fast_do_not),
        cmocka_unit_test(a_file_that_an_option_names_counts_with_its_state),
    };
    return cmocka_run_group_tests(tests, begin, end);
}
