/* test_window_files.c: what the window saves is what it opens, and what `render` makes; what is kept against a crash.
 */
#include "hand.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "window/file_kind.h"
#include "window/files.h"
#include "window/loader.h"
#include "window/picture_job.h"
#include "window/presets.h"

static tc_hand hand;
static GtkWindow *window;
static char folder[200];

static void wait_ms(int ms)
{
    const gint64 end = g_get_monotonic_time() + ms * (gint64)1000;
    while (g_get_monotonic_time() < end) {
        while (g_main_context_iteration(NULL, FALSE))
            ;
        g_usleep(2000);
    }
}

static void read_whole(void)
{
    wait_ms(50);
    for (int i = 0; i < 3000 && hand.session.busy; i++)
        wait_ms(10);
}

static char *path_of(const char *name)
{
    return g_build_filename(folder, name, NULL);
}

static void write_text(const char *path, const char *text)
{
    assert_true(g_file_set_contents(path, text, -1, NULL));
}

/* A function, a camera and an effect that are no defaults. */
static int set_up(void **state)
{
    (void)state;
    tc_hand_fresh(&hand);
    hand.session.camera = hand.session.home;
    tc_document *d = hand.session.document;
    size_t index;
    assert_int_equal(tc_document_add_point(d, &index, 0.37, 1.25, NULL), TC_OK);
    d->point[index].sharpness = 0.25;
    d->range[0] += 0.1 * (d->range[1] - d->range[0]);
    tc_session_edited(&hand.session, "add a point");
    tc_camera_azimuth(&hand.session.camera, 33);
    assert_true(tc_session_set(&hand.session, "--outline", "on"));
    return 0;
}

static void camera_is(const tc_camera *camera)
{
    for (int i = 0; i < 3; i++)
        assert_float_equal(hand.session.camera.position[i], camera->position[i], 1e-12);
}

/* The function is that one, but for the last bits of places that went through the scalar and back. */
static void same(const tc_document *saved)
{
    const tc_document *d = hand.session.document;
    const double unit =
        saved->unit_distance > 0 ? saved->unit_distance : tc_default_unit_distance(hand.session.run.mesh);
    assert_int_equal(d->n_point, saved->n_point);
    assert_int_equal(d->n_color, saved->n_color);
    assert_int_equal(d->space, saved->space);
    assert_int_equal(d->log, saved->log);
    for (int i = 0; i < 2; i++)
        assert_float_equal(d->range[i], saved->range[i], 0);
    for (size_t i = 0; i < d->n_point; i++) {
        assert_float_equal(d->point[i].x, saved->point[i].x, 1e-14);
        assert_float_equal(d->point[i].a, saved->point[i].a, 0);
        assert_float_equal(d->point[i].midpoint, saved->point[i].midpoint, 0);
        assert_float_equal(d->point[i].sharpness, saved->point[i].sharpness, 0);
    }
    for (size_t i = 0; i < d->n_color; i++) {
        assert_float_equal(d->color[i].x, saved->color[i].x, 1e-14);
        assert_memory_equal(d->color[i].rgb, saved->color[i].rgb, sizeof saved->color[i].rgb);
    }
    assert_float_equal(d->unit_distance > 0 ? d->unit_distance : tc_default_unit_distance(hand.session.run.mesh), unit,
                       1e-12 * unit); /* a scene tells the one in force */
}

static void a_file_is_taken_for_another_kind(void **state)
{
    (void)state;
    static const struct {
        const char *name, *text;
        tc_file_kind kind;
    } file[] = {{"preset.json", "[{\"Name\": \"A\", \"RGBPoints\": [0, 0,0,0, 1, 1,1,1]},]", TC_FILE_PRESET},
                {"preset.xml",
                 "<ColorMap name=\"x\"><Point x=\"0\" r=\"0\" g=\"0\" b=\"0\"/>"
                 "<Point x=\"1\" r=\"1\" g=\"0\" b=\"0\"/></ColorMap>",
                 TC_FILE_PRESET},
                {"scene.json", "{\"data\": \"synth:kuhn\"}", TC_FILE_SCENE},
                {"state.pvsm", "<ParaView/>", TC_FILE_SCENE},
                {"picture.png", "", TC_FILE_PICTURE},
                {"data.vtu", "<VTKFile/>", TC_FILE_DATA}};
    for (size_t i = 0; i < sizeof file / sizeof *file; i++) {
        char *path = path_of(file[i].name);
        write_text(path, file[i].text);
        if (tc_file_kind_of(path) != file[i].kind)
            fail_msg("%s is taken for %d", path, tc_file_kind_of(path));
        g_free(path);
    }
}

static void a_scene_opens_otherwise_than_it_was_saved(void **state)
{
    (void)state;
    char *path = path_of("saved.json"), *text = tc_session_scene(&hand.session);
    tc_document *saved;
    const tc_camera camera = hand.session.camera;
    assert_non_null(text);
    assert_int_equal(tc_document_copy(&saved, hand.session.document, NULL), TC_OK);
    write_text(path, text);
    tc_hand_fresh(&hand);
    hand.session.camera = hand.session.home;
    assert_true(tc_session_set(&hand.session, "--outline", NULL));
    tc_files_open(window, &hand.session, path);
    read_whole();
    same(saved);
    camera_is(&camera);
    assert_true(hand.session.options.look.outline);
    tc_session_undo(&hand.session); /* it is one step */
    assert_true(tc_document_equal(hand.session.document, hand.start));
    tc_session_redo(&hand.session);
    same(saved);
    write_text(path, "{\"data\": \"synth:kuhn\", \"transfer_functoin\": {}}");
    *hand.session.said = 0;
    tc_files_open(window, &hand.session, path);
    read_whole();
    assert_non_null(strstr(hand.session.said, "transfer_function"));
    same(saved);
    write_text(path, "{\"data\": \"/no/such/file.vtu\"}");
    *hand.session.said = 0;
    tc_files_open(window, &hand.session, path);
    read_whole();
    assert_non_null(strstr(hand.session.said, "/no/such/file.vtu"));
    same(saved); /* whole or not at all */
    assert_non_null(hand.session.run.mesh);
    camera_is(&camera);
    tc_document_destroy(&saved);
    free(text);
    g_free(path);
}

static void a_picture_is_not_what_render_makes(void **state)
{
    (void)state;
    char *path = path_of("saved.png"), *again = path_of("again.png"), *odd = path_of("no/folder.png"), why[1024];
    assert_true(tc_session_set(&hand.session, "--size", "160x120"));
    tc_picture_job *job = tc_picture_job_new(&hand.session, path);
    tc_document *saved;
    const tc_camera camera = hand.session.camera;
    assert_non_null(job);
    assert_int_equal(tc_document_copy(&saved, hand.session.document, NULL), TC_OK);
    tc_hand_fresh(&hand); /* what comes later is not in it */
    if (!tc_picture_job_run(job, why))
        fail_msg("%s", why);
    tc_picture_job_free(job);
    char *program = g_build_filename(getenv("TETCAST_HELPERS"), "tetcast", NULL);
    const char *const argv[] = {program, "render", path, "-q", "-o", again, NULL};
    int status = -1;
    assert_true(g_spawn_sync(NULL, (char **)argv, NULL, G_SPAWN_DEFAULT, NULL, NULL, NULL, NULL, &status, NULL));
    assert_int_equal(status, 0);
    tc_image *a, *b;
    tc_compare_result difference;
    assert_int_equal(tc_image_read(&a, path, NULL), TC_OK);
    assert_int_equal(tc_image_read(&b, again, NULL), TC_OK);
    assert_int_equal(a->width, 160);
    assert_int_equal(tc_image_compare(&difference, a, b, NULL), TC_OK);
    assert_true(difference.covered > 1000);
    assert_float_equal(difference.max_abs, 0, 1e-6);
    tc_image_destroy(&a);
    tc_image_destroy(&b);
    hand.session.camera = hand.session.home;
    tc_files_open(window, &hand.session, path);
    read_whole();
    same(saved);
    camera_is(&camera);
    job = tc_picture_job_new(&hand.session, odd);
    assert_false(tc_picture_job_run(job, why));
    assert_non_null(strstr(why, "no/folder.png"));
    tc_picture_job_free(job);
    tc_document_destroy(&saved);
    g_free(program);
    g_free(path);
    g_free(again);
    g_free(odd);
}

static void the_command_line_is_not_that_of_the_picture(void **state)
{
    (void)state;
    char *text = tc_session_command(&hand.session), **argv = NULL;
    int argc = 0;
    assert_non_null(text);
    assert_true(g_shell_parse_argv(text, &argc, &argv, NULL));
    assert_string_equal(argv[0], "tetcast");
    assert_string_equal(argv[1], "render");
    char name[] = "edit";
    argv[1] = (g_free(argv[1]), g_strdup(name));
    tc_document *saved;
    const tc_camera camera = hand.session.camera;
    assert_int_equal(tc_document_copy(&saved, hand.session.document, NULL), TC_OK);
    tc_hand_fresh(&hand);
    hand.session.camera = hand.session.home;
    assert_true(tc_session_reopen(&hand.session, argc - 1, argv + 1));
    assert_true(tc_loader_start(&hand.session));
    read_whole();
    same(saved);
    camera_is(&camera);
    assert_true(hand.session.options.look.outline);
    g_strfreev(argv);
    free(text);
    tc_document_destroy(&saved);
}

/* Files in the folder of what is kept. */
static int kept(void)
{
    char *path = g_build_filename(g_getenv("XDG_STATE_HOME"), "tetcast", NULL);
    GDir *dir = g_dir_open(path, 0, NULL);
    int n = 0;
    for (const char *name; dir && (name = g_dir_read_name(dir));)
        n += g_str_has_suffix(name, ".json");
    if (dir)
        g_dir_close(dir);
    g_free(path);
    return n;
}

static void changes_are_not_kept_or_stay_behind(void **state)
{
    (void)state;
    for (int i = 0; i < 60 && kept() == 0; i++)
        wait_ms(100);
    assert_int_equal(kept(), 1);
    gtk_window_destroy(window);
    wait_ms(100);
    assert_int_equal(kept(), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_file_is_taken_for_another_kind),
        cmocka_unit_test_setup(a_scene_opens_otherwise_than_it_was_saved, set_up),
        cmocka_unit_test_setup(a_picture_is_not_what_render_makes, set_up),
        cmocka_unit_test_setup(the_command_line_is_not_that_of_the_picture, set_up),
        cmocka_unit_test_setup(changes_are_not_kept_or_stay_behind, set_up),
    };
    g_snprintf(folder, sizeof folder, "%s/tc_files_XXXXXX", g_get_tmp_dir());
    if (!g_mkdtemp(folder))
        return 1;
    g_setenv("XDG_STATE_HOME", folder, TRUE);
    gtk_init();
    GtkApplication *application = gtk_application_new("org.tetcast.test", G_APPLICATION_NON_UNIQUE);
    g_application_register(G_APPLICATION(application), NULL, NULL);
    tc_hand_open(&hand, "synth:kuhn");
    window = GTK_WINDOW(gtk_application_window_new(application));
    gtk_window_set_titlebar(window, gtk_header_bar_new());
    gtk_window_set_child(window, tc_presets_new(&hand.session));
    tc_files_attach(window, &hand.session);
    gtk_window_present(window);
    wait_ms(500);
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    hand.window = gtk_window_new();
    tc_hand_close(&hand);
    g_object_unref(application);
    char *command = g_strdup_printf("rm -rf '%s'", folder);
    const int removed = system(command);
    g_free(command);
    return failed || removed;
}
