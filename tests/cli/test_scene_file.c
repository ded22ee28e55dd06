/* test_scene_file.c: scene files as options, and the options of a look, judged without a picture. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "cli/picture/categories.h"
#include "cli/commands.h"
#include "cli/picture/render_options.h"
#include "cli/scene/scene_lines.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* The command behind the table: not reached by a command line that is only read. */
int tc_render_run_command(tc_talk *talk, const tc_command *command, int argc, char **argv)
{
    (void)talk, (void)command, (void)argc, (void)argv;
    return TC_EXIT_DONE;
}

static tc_talk talk;

static int quiet_start(void **state)
{
    (void)state;
    tc_talk_init(&talk);
    return freopen("/dev/null", "w", stderr) ? 0 : -1;
}

/* The options after the words of a command line, up to NULL; the exit code. */
static int read_line(tc_render_command *out, const char *const *word)
{
    char *argv[32] = {(char *)"render"};
    int argc = 1;
    while (word[argc - 1]) {
        argv[argc] = (char *)word[argc - 1];
        argc++;
    }
    return tc_render_command_read(out, &talk, &tc_command_render, argc, argv);
}
#define READ(out, ...) read_line(out, (const char *const[]){__VA_ARGS__, NULL})

static void scene_write(const char *path, const char *text)
{
    FILE *stream = fopen(path, "w");
    assert_non_null(stream);
    fputs(text, stream);
    assert_int_equal(fclose(stream), 0);
}

/* ---------------------------------------------------------------------------------------------------------- keys */

static void each_option_has_one_key_and_each_key_an_option(void **state)
{
    (void)state;
    size_t n = 0, found = 0;
    const tc_scene_key *key = tc_scene_keys(&n);
    for (size_t k = 0; k < n; k++) {
        const bool batch = key[k].role == TC_KEY_BATCH;
        const char *const lists[] = {"--views", "--times"}; /* keys alone */
        if (batch && (!strcmp(key[k].option, lists[0]) || !strcmp(key[k].option, lists[1])))
            continue;
        if (key[k].option && !tc_command_option(batch ? &tc_command_batch : &tc_command_render, key[k].option))
            fail_msg("%s.%s is of no option", key[k].section, key[k].key);
        assert_true(!batch || !tc_command_option(&tc_command_render, key[k].option));
    }
    for (int table = 0; table < 2; table++) {
        const tc_option *option = table ? tc_command_render.also : tc_command_render.option;
        for (size_t i = 0; i < (table ? tc_command_render.n_also : tc_command_render.n_option); i++) {
            size_t times = 0;
            if (!option[i].name || option[i].kind == TC_OPTION_LATER)
                continue;
            for (size_t k = 0; k < n; k++)
                times += key[k].option && !strcmp(key[k].option, option[i].name);
            if (times != 1)
                fail_msg("%s has %zu keys", option[i].name, times);
            found++;
        }
    }
    assert_true(found > 60);
}

static void lines_are_those_of_the_keys_in_their_section(void **state)
{
    (void)state;
    static const char text[] = "{\n\"a\": {\"x\": 1,\n \"y\": \"}\\\"{\"},\n\"b\": [[{\"x\": 2}], 3],\n\n"
                               "\"c\": {\"x\":\n {\"y\": 0}, \"z\": \"\\\\\"\n,\"y\": true}, \"d\": 1}";
    assert_int_equal(tc_json_line(text, "", "a"), 2);
    assert_int_equal(tc_json_line(text, "a", "x"), 2);
    assert_int_equal(tc_json_line(text, "a", "y"), 3);
    assert_int_equal(tc_json_line(text, "", "b"), 4);
    assert_int_equal(tc_json_line(text, "c", "x"), 6);
    assert_int_equal(tc_json_line(text, "c", "y"), 8);
    assert_int_equal(tc_json_line(text, "", "d"), 8);
    assert_int_equal(tc_json_line(text, "c", "none"), 6); /* the section's */
    assert_int_equal(tc_json_line(text, "b", "x"), 4);    /* no object */
    assert_int_equal(tc_json_line("\xef\xbb\xbf{\n\n\"k\":0}", "", "k"), 3);
    assert_int_equal(tc_json_line("{}", "s", "k"), 1);
}

/* -------------------------------------------------------------------------------------------------------- values */

static void check_text(const char *json, const char *option, const char *text)
{
    tc_scene scene;
    assert_int_equal(tc_scene_parse(&scene, json, "s.json", "dir", &tc_command_render, &talk), -1);
    const char *last = "";
    for (size_t i = 0; i < scene.n; i++)
        if (!strcmp(scene.item[i].option->name, option))
            last = scene.item[i].text ? scene.item[i].text : "(none)";
    assert_string_equal(last, text);
    tc_scene_finish(&scene);
}

static void values_become_what_a_command_line_would_say(void **state)
{
    (void)state;
    check_text("{\"output\": {\"size\": [640, 480]}}", "--size", "640x480");
    check_text("{\"output\": {\"size\": \"640x480\"}}", "--size", "640x480");
    check_text("{\"camera\": {\"position\": [1, -2.5, 0.1]}}", "--camera-position", "1,-2.5,0.10000000000000001");
    check_text("{\"transfer_function\": {\"opacity\": [[0, 0], [1.5, 0.25]]}}", "--opacity", "0:0,1.5:0.25");
    check_text("{\"transfer_function\": {\"log\": true}}", "--log", "on");
    check_text("{\"transfer_function\": {\"log\": false}}", "--log", "off");
    check_text("{\"effects\": {\"iso\": 3}}", "--iso", "3");
    check_text("{\"effects\": {\"iso\": [1, 2]}}", "--iso", "1,2");
    check_text("{\"effects\": {\"iso_color\": [1, 0, 0]}}", "--iso-color", "1,0,0");
    check_text("{\"effects\": {\"iso_color\": [[1, 0, 0], [0, 1, 0]]}}", "--iso-color", "1,0,0;0,1,0");
    check_text("{\"effects\": {\"light\": [\"head\", [0, 0, 1]]}}", "--light", "head;0,0,1");
    check_text("{\"effects\": {\"clip\": [[0, 0, 0, 1, 0, 0], [0, 0, 0, 0, 1, 0]]}}", "--clip",
               "0,0,0,1,0,0;0,0,0,0,1,0");
    check_text("{\"effects\": {\"select\": [\"T:1,2\", \"a;b:3\"]}}", "--select", "a;b:3");
    check_text("{\"effects\": {\"categories\": [\"1:1,0,0\", \"2:0,1,0\"]}}", "--categories", "1:1,0,0;2:0,1,0");
    check_text("{\"effects\": {\"blocks\": [\"1:3\", 7]}}", "--blocks", "1:3,7");
    check_text("{\"effects\": {\"surface\": true}}", "--surface", "(none)");
    check_text("{\"effects\": {\"surface\": false}}", "--surface", "off");
    check_text("{\"effects\": {\"surface\": 0.5}}", "--surface", "0.5");
    check_text("{\"method\": {\"samples\": 16}}", "--samples", "16");
    check_text("{\"step\": -1}", "--step", "-1");
    check_text("{\"seed\": \"18446744073709551615\"}", "--seed", "18446744073709551615");
}

static void paths_lead_from_the_scenes_folder(void **state)
{
    (void)state;
    check_text("{\"output\": {\"file\": \"a.png\"}}", "--output", "dir/a.png");
    check_text("{\"output\": {\"file\": \"/a.png\"}}", "--output", "/a.png");
    check_text("{\"output\": {\"stats\": \"-\"}}", "--stats", "-");
    check_text("{\"effects\": {\"geometry\": [\"a.stl,0.5\"]}}", "--geometry", "dir/a.stl,0.5");
    check_text("{\"transfer_function\": {\"color_map\": \"Viridis\"}}", "--color-map", "Viridis");
    tc_scene scene;
    static const char *const data[][3] = {{"f.vtu", "x", "x/f.vtu"},
                                          {"/f.vtu", "x", "/f.vtu"},
                                          {"synth:ball", "x", "synth:ball"},
                                          {"f.vtu", "", "f.vtu"}};
    for (size_t i = 0; i < sizeof data / sizeof *data; i++) {
        char text[64];
        snprintf(text, sizeof text, "{\"data\": \"%s\"}", data[i][0]);
        assert_int_equal(tc_scene_parse(&scene, text, "s", data[i][1], &tc_command_render, &talk), -1);
        assert_string_equal(scene.data, data[i][2]);
        tc_scene_finish(&scene);
    }
}

static void wrong_scenes_are_refused_whole(void **state)
{
    (void)state;
    static const char *const wrong[] = {"",
                                        "[]",
                                        "3",
                                        "{",
                                        "{\"data\": 1}",
                                        "{\"data\": \"\"}",
                                        "{\"dta\": \"a\"}",
                                        "{\"camera\": 1}",
                                        "{\"camera\": {\"psition\": 1}}",
                                        "{\"size\": [1, 2]}",
                                        "{\"camera\": {\"camera\": {}}}",
                                        "{\"camera\": {\"zoom\": true}}",
                                        "{\"camera\": {\"zoom\": null}}",
                                        "{\"camera\": {\"zoom\": \"2\"}}",
                                        "{\"camera\": {\"parallel\": 1}}",
                                        "{\"camera\": {\"position\": []}}",
                                        "{\"camera\": {\"position\": [true, 1, 1]}}",
                                        "{\"camera\": {\"position\": [[[1]]]}}",
                                        "{\"step\": 1, \"step\": 2}",
                                        "{\"effects\": {\"select\": [\"a:1\", {}]}}",
                                        "{\"effects\": {\"iso\": {}}}",
                                        "{\"views\": 3}",
                                        "{\"shell\": {}}",
                                        "{\"transfer_function\": [{}]}",
                                        "{\"data\": [\"a.vtu\"]}",
                                        "{\"field\": 7}",
                                        "{\"refine\": 1.5}",
                                        "{\"output\": {\"quiet\": true}}"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        tc_scene scene;
        if (tc_scene_parse(&scene, wrong[i], "s.json", NULL, &tc_command_render, &talk) != TC_EXIT_FAILED)
            fail_msg("'%s' is taken", wrong[i]);
        assert_true(scene.n == 0 && !scene.item && !scene.data);
    }
}

/* ----------------------------------------------------------------------------------------------- line over scene */

static void the_command_line_stands_before_the_scene(void **state)
{
    (void)state;
    tc_render_command r;
    scene_write(
        "scene_test.json",
        "{\"data\": \"synth:ball\", \"field\": \"T\", \"cell_data\": true, \"step\": 4, \"camera\": {\"azimuth\": 30},"
        " \"transfer_function\": {\"range\": [1, 2], \"log\": true, \"color_map\": \"Viridis\", \"preset\": \"p\"},"
        " \"effects\": {\"iso\": [1, 2], \"iso_color\": [[1, 0, 0], [0, 1, 0]], \"clip\": [0, 0, 0, 1, 0, 0],"
        " \"surface\": true}, \"output\": {\"size\": [32, 24], \"file\": \"out.png\"}}");
    assert_int_equal(READ(&r, "scene_test.json"), -1);
    assert_string_equal(r.input, "synth:ball");
    assert_string_equal(r.output, "out.png");
    assert_true(r.size.width == 32 && r.size.height == 24 && r.azimuth == 30 && r.log && r.has_range);
    assert_true(r.look.iso.n == 2 && r.look.iso_color.n == 2 && r.look.clip.n == 1 && r.source.step == 4);
    assert_true(r.look.has_surface && r.look.surface == 1);
    tc_render_command_finish(&r);

    assert_int_equal(READ(&r, "--size", "8x9", "scene_test.json", "--log=off", "--iso", "5", "--time", "0.5", "--field",
                          "P", "--clip", "0,0,0,0,1,0", "--clip", "0,0,0,0,0,1", "-o", "b.png"),
                     -1);
    assert_true(r.size.width == 8 && r.size.height == 9 && !r.log && r.azimuth == 30);
    assert_true(r.look.iso.n == 1 && r.look.iso.value[0] == 5 && r.look.iso_color.n == 0);
    assert_true(r.source.has_time && !r.source.has_step && !r.source.cell_data && !r.has_range);
    assert_true(r.look.clip.n == 2 && r.look.clip.plane[0].normal[1] == 1);
    assert_string_equal(r.output, "b.png");
    tc_render_command_finish(&r);

    assert_int_equal(READ(&r, "scene_test.json", "--time", "50ms"), -1); /* a frame's time, not the data's */
    assert_true(r.source.has_step && r.source.step == 4 && r.frame_time == 50);
    tc_render_command_finish(&r);
    assert_int_equal(READ(&r, "scene_test.json", "--categories", "1:1,0,0"), -1);
    assert_true(!r.has_range && !r.log && !r.color_map && !r.preset);
    tc_render_command_finish(&r);
    assert_int_equal(READ(&r, "scene_test.json", "--stats", "scene_test.json"), TC_EXIT_USAGE);
    tc_render_command_finish(&r);
    scene_write("scene_test.json", "{\"data\": \"synth:ball\", \"camera\": {\"zoom\": -1}}");
    assert_int_equal(READ(&r, "scene_test.json"), TC_EXIT_FAILED);
    tc_render_command_finish(&r);
    scene_write("scene_test.json", "{\"camera\": {\"zoom\": 2}}");
    assert_int_equal(READ(&r, "scene_test.json"), TC_EXIT_FAILED); /* no data */
    tc_render_command_finish(&r);
    unlink("scene_test.json");
}

/* ---------------------------------------------------------------------------------------------------------- looks */

static void lists_of_a_look_are_read_whole(void **state)
{
    (void)state;
    tc_render_command r;
    assert_int_equal(READ(&r, "synth:ball", "--select", "a:b:1,2;c:3", "--select", "d:-1,1", "--geometry",
                          "a,b.stl,0.5", "--geometry", "c.vtp", "--clip", "1,2,3,0,0,2;0,0,0,1,0,0;", "--blocks",
                          "1,3:5", "--light", "head;0,1,0", "--shade", "cell", "--clip-box", "0,1,2,3,4,5"),
                     -1);
    assert_int_equal(r.look.select.n, 3);
    assert_true(tc_part_is(&r.look.select.range[0].name, "a:b") && r.look.select.range[0].hi == 2);
    assert_true(tc_part_is(&r.look.select.range[1].name, "c") && r.look.select.range[1].lo == 3);
    assert_true(r.look.select.range[1].hi == 3 && r.look.select.range[2].lo == -1);
    assert_int_equal(r.look.geometry.n, 2);
    assert_true(tc_part_is(&r.look.geometry.file[0].file, "a,b.stl") && r.look.geometry.file[0].opacity == 0.5);
    assert_true(tc_part_is(&r.look.geometry.file[1].file, "c.vtp") && r.look.geometry.file[1].opacity == 1);
    assert_true(r.look.clip.n == 2 && r.look.clip.plane[0].offset == 6 && r.look.clip.plane[0].normal[2] == 2);
    assert_true(r.look.blocks.n == 2 && r.look.blocks.range[1].lo == 3 && r.look.blocks.range[1].hi == 5);
    assert_true(r.look.light.n == 2 && r.look.light.light[0].head && !r.look.light.light[1].head);
    assert_true(r.look.light.light[1].direction[1] == 1 && r.look.light.light[1].color[2] == 1);
    assert_true(r.look.has_clip_box && r.look.clip_box[5] == 5 && r.look.shade.ambient == 0.2);
    tc_render_command_finish(&r);
    assert_int_equal(READ(&r, "--surface", "synth:ball"), -1); /* no number: it is INPUT */
    assert_true(r.look.surface == 1 && !strcmp(r.input, "synth:ball"));
    tc_render_command_finish(&r);
    assert_int_equal(READ(&r, "--surface", "0.25", "synth:ball"), -1);
    assert_true(r.look.surface == 0.25);
    tc_render_command_finish(&r);
}

static void light_alone_is_seen_on_black(void **state)
{
    (void)state;
    tc_render_command r;
    assert_int_equal(READ(&r, "synth:ball", "--model", "emission"), -1);
    assert_true(r.background.there && r.background.rgba[0] == 0 && r.background.rgba[3] == 1);
    tc_render_command_finish(&r);
    assert_int_equal(READ(&r, "synth:ball", "--model", "emission", "--background", "transparent"), -1);
    assert_false(r.background.there);
    tc_render_command_finish(&r);
}

/* ------------------------------------------------------------------------------------------------------ categories */

static tc_category_list list;

static void function_of(tc_transfer **tf, const char *text)
{
    static const double range[2] = {3, 9};
    tc_category_list_finish(&list);
    assert_int_equal(tc_categories_make(tf, &list, text, range, &talk), -1);
}

static void categories_meet_half_way(void **state)
{
    (void)state;
    tc_transfer *tf = NULL;
    size_t n = 0;
    function_of(&tf, "5:0,0,1,0.5; 1:1,0,0"); /* in any order */
    const tc_knot *k = tc_transfer_knots(tf, &n);
    assert_int_equal(n, 4);
    assert_true(k[1].s == 3 && k[2].s == 3 && k[0].r == 1 && k[1].r == 1 && k[0].a == 1);
    assert_true(k[2].b == 1 && k[3].b == 1 && k[2].a == 0.5 && k[2].r == 0);
    tc_transfer_destroy(&tf);
    scene_write("categories_test.txt", "# materials\n1: 1,0,0 \r\n\n2:0,1,0,0.25:hard steel # B\n");
    function_of(&tf, "categories_test.txt");
    k = tc_transfer_knots(tf, &n);
    assert_true(n == 4 && k[1].s == 1.5 && k[2].g == 1 && k[2].a == 0.25);
    assert_true(list.n == 2 && list.value[1] == 2 && !list.name[0] && !strcmp(list.name[1], "hard steel"));
    tc_transfer_destroy(&tf);
    scene_write("categories_test.txt", "[{\"Name\": \"a\"}, {\"Name\": \"b\", \"IndexedColors\": [1, 0, 0, 0, 1, 0,],\n"
                                       "\"Annotations\": [\"7\", \"a\", \"2\", \"b,]\", \"4\", \"c\"],\n},\n]\n");
    function_of(&tf, "categories_test.txt");
    k = tc_transfer_knots(tf, &n);
    assert_true(list.n == 3 && !strcmp(list.name[0], "b,]") && !strcmp(list.name[2], "a") && list.value[2] == 7);
    assert_true(n == 6 && k[1].s == 3 && k[0].g == 1 && k[2].r == 1 && k[4].r == 1); /* 2 green, 4 and 7 red */
    tc_transfer_destroy(&tf);
    scene_write("categories_test.txt", "{\"IndexedColors\": [1, 0, 0, 0, 1, 0]}");
    function_of(&tf, "categories_test.txt");
    k = tc_transfer_knots(tf, &n);
    assert_true(n == 4 && k[0].s == 2.5 && k[1].s == 3.5 && k[3].s == 4.5); /* from the least value on */
    tc_transfer_destroy(&tf);
    for (int preset = 0; preset < 2; preset++) { /* as editors of Windows save it */
        scene_write("categories_test.txt", preset ? "\xef\xbb\xbf{\"IndexedColors\": [1, 0, 0]}"
                                                  : "\xef\xbb\xbf"
                                                    "3:1,0,0\n");
        function_of(&tf, "categories_test.txt");
        assert_true(list.n == 1 && list.value[0] == 3);
        tc_transfer_destroy(&tf);
    }
    static const char *const wrong[] = {"",           ";",      "1:2,0,0",    "1:0,0", "x:0,0,0", "1:0,0,0;1:1,1,1",
                                        "1:0,0,0,-1", "nofile", "1:0,0,0,0,0"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        if (tc_categories_make(&tf, &list, wrong[i], (const double[2]){0, 1}, &talk) != TC_EXIT_USAGE)
            fail_msg("'%s' is taken, or a failure", wrong[i]);
    static const char *const wrong_file[] = {"",
                                             "[]",
                                             "[{\"IndexedColors\": [1, 0]}]",
                                             "{\"IndexedColors\": [1, 2, 0]}",
                                             "{\"IndexedColors\": [\"1\", 0, 0]}",
                                             "{\"IndexedColors\": [1, 0, null]}",
                                             "1:1,0,0\n1:0,0,0",
                                             "1:1,0,0\nx",
                                             "{\"IndexedColors\": [1, 1, 0], \"Annotations\": [\"a\", \"a\"]}",
                                             "{"};
    for (size_t i = 0; i < sizeof wrong_file / sizeof *wrong_file; i++) {
        scene_write("categories_test.txt", wrong_file[i]);
        if (tc_categories_make(&tf, &list, "categories_test.txt", (const double[2]){0, 1}, &talk) != TC_EXIT_FAILED)
            fail_msg("a file of '%s' is taken, or a wrong use", wrong_file[i]);
    }
    tc_category_list_finish(&list);
    unlink("categories_test.txt");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_option_has_one_key_and_each_key_an_option),
        cmocka_unit_test(lines_are_those_of_the_keys_in_their_section),
        cmocka_unit_test(values_become_what_a_command_line_would_say),
        cmocka_unit_test(paths_lead_from_the_scenes_folder),
        cmocka_unit_test(wrong_scenes_are_refused_whole),
        cmocka_unit_test(the_command_line_stands_before_the_scene),
        cmocka_unit_test(lists_of_a_look_are_read_whole),
        cmocka_unit_test(light_alone_is_seen_on_black),
        cmocka_unit_test(categories_meet_half_way),
    };
    return cmocka_run_group_tests(tests, quiet_start, NULL);
}
