/* Tests of the list of colour maps to choose from. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "edit/map_list.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static tc_map_list *list_of(const char *file)
{
    tc_map_list *list;
    tc_error err = {0};
    if (tc_map_list_read(&list, file, &err))
        fail_msg("%s", err.text);
    return list;
}

static void a_built_in_map_is_missing_or_looks_otherwise(void **state)
{
    (void)state;
    size_t n;
    const char *const *name = tc_transfer_builtin(&n);
    tc_map_list *list = list_of(NULL);
    assert_int_equal(list->n, n);
    for (size_t i = 0; i < n; i++) {
        const tc_map_entry *entry = &list->entry[i];
        const tc_transfer_options options = {.color_map = name[i], .has_range = true, .range = {-5, 11}};
        tc_transfer *tf;
        unsigned char rgb[TC_MAP_STRIP][3];
        assert_string_equal(entry->name, name[i]);
        assert_null(entry->file);
        assert_false(entry->has_opacity);
        assert_int_equal(tc_transfer_create(&tf, &options, NULL), TC_OK);
        tc_map_strip(rgb, NULL, TC_MAP_STRIP, tf);
        for (int k = 0; k < TC_MAP_STRIP; k++)
            for (int c = 0; c < 3; c++)
                assert_in_range(entry->strip[k][c] + 2 - rgb[k][c], 1, 3);
        tc_transfer_destroy(&tf);
    }
    assert_true(list->entry[0].strip[0][2] > 150 && list->entry[0].strip[0][0] < 80); /* Cool to Warm: from blue */
    assert_true(list->entry[0].strip[255][0] > 150 && list->entry[0].strip[255][2] < 80);
    tc_map_list_destroy(&list);
}

static void a_strip_is_not_the_functions_values(void **state)
{
    (void)state;
    const tc_knot knot[] = {{10, 0, 0, 0, 0}, {15, 1, 0, 0, 2}, {15, 0, 0, 1, 1}, {20, 0, 1, 1, 1}};
    unsigned char rgb[10][3];
    float opacity[10];
    tc_transfer *tf;
    assert_int_equal(tc_transfer_from_knots(&tf, knot, 4, NULL), TC_OK);
    tc_map_strip(rgb, opacity, 10, tf);
    assert_int_equal(rgb[0][0], 26); /* 10.5: a tenth of 255 */
    assert_int_equal(rgb[4][0], 230);
    assert_int_equal(rgb[5][0], 0); /* behind the step */
    assert_int_equal(rgb[5][2], 255);
    assert_float_equal(opacity[4], 1.8, 1e-6);
    assert_float_equal(opacity[9], 1, 1e-6);
    tc_transfer_destroy(&tf);
}

static void maps_of_a_file_are_lost_or_come_twice(void **state)
{
    (void)state;
    static const char text[] =
        "[{\"Name\": \"Points\", \"RGBPoints\": [0, 1,0,0, 1, 0,1,0]},\n"
        " {\"Name\": \"Peaks of B\", \"RGBPoints\": [0, 1,0,0, 1, 0,0,1], \"Points\": [0,0,0.5,0, 1,4,0.5,0]},\n"
        " {\"Name\": \"Points\", \"RGBPoints\": [0, 1,0,0, 1, 0,1,0]},\n"
        " {\"Name\": \"Points\", \"RGBPoints\": [0, 0,0,1, 1, 0,1,0]},]\n";
    const char *folder = getenv("TMPDIR");
    char path[256];
    snprintf(path, sizeof path, "%s/tc_map_list_%ld.json", folder ? folder : "/tmp", (long)getpid());
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
    tc_map_list *list = list_of(path);
    assert_int_equal(list->n, 3);
    assert_false(list->entry[0].has_opacity);
    assert_true(list->entry[1].has_opacity);
    assert_float_equal(list->entry[1].opacity[255], 1, 0);
    assert_float_equal(list->entry[1].opacity[0] * 511, 1, 1e-3);
    assert_string_equal(list->entry[1].file, path);
    assert_int_equal(list->entry[2].strip[0][2], 255); /* one of the same name, that is another */
    assert_true(tc_map_matches(&list->entry[1], "peaks"));
    assert_true(tc_map_matches(&list->entry[1], "  B  PEA "));
    assert_true(tc_map_matches(&list->entry[1], "map_list of"));
    assert_true(tc_map_matches(&list->entry[1], ""));
    assert_false(tc_map_matches(&list->entry[1], "peaks x"));
    assert_false(tc_map_matches(&list->entry[1], "tmp/")); /* folders do not count */
    tc_document *document;
    const double range[2] = {0, 8};
    assert_int_equal(tc_document_create(&document, range, NULL), TC_OK);
    assert_int_equal(tc_document_take_preset(document, list->entry[2].text, NULL, NULL), TC_OK);
    assert_float_equal(document->color[0].rgb[2], 1, 0);
    tc_document_destroy(&document);
    tc_map_list_destroy(&list);
    assert_null(list);
    unlink(path);
    tc_error err = {0};
    assert_int_equal(tc_map_list_read(&list, path, &err), TC_E_FILE);
    assert_null(list);
    assert_non_null(strstr(err.text, path));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_built_in_map_is_missing_or_looks_otherwise),
        cmocka_unit_test(a_strip_is_not_the_functions_values),
        cmocka_unit_test(maps_of_a_file_are_lost_or_come_twice),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
