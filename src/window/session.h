/* session.h: all that one window is about, without the window: data, function, camera, look, and who wants to know of
 * changes. No GTK here. Calls come from the main thread. */
#ifndef TC_WINDOW_SESSION_H
#define TC_WINDOW_SESSION_H

#include "cli/picture/render_setup.h"
#include "edit/history.h"
#include "edit/trace.h"
#include "window/held.h"
#include "window/settings.h"

/* What changed; bits. */
typedef enum tc_change {
    TC_CHANGE_FUNCTION = 1,  /* the document, but for what is selected */
    TC_CHANGE_SELECTION = 2, /* which points and colours are */
    TC_CHANGE_CAMERA = 4,
    TC_CHANGE_LOOK = 8,     /* any other option that makes the picture */
    TC_CHANGE_DATA = 16,    /* mesh, field or step: the run, its report and the histogram are new */
    TC_CHANGE_HISTORY = 32, /* what can be undone */
    TC_CHANGE_BUSY = 64,    /* something is being read, or no longer */
    TC_CHANGE_SAID = 128    /* said */
} tc_change;

/* changes: bits of tc_change; 0: the hand was taken off, what moved is at rest. */
typedef void tc_session_heard(void *user, unsigned changes);

typedef struct tc_session {
    tc_talk talk;
    const tc_command *command; /* of the options' table */
    tc_trace *trace;
    tc_settings *settings; /* the words of options */
    tc_settings *wanted;   /* those of tc_session_reopen, until their data are there or cannot be read; NULL: none */
    tc_render_command options; /* of the command line, or of the scene that was opened; --opacity, --color-map, --range,
                                  --log, --unit-distance, --nan-color and the camera's are those of the beginning:
                                  document and camera hold now. Its texts are those of settings */
    tc_render_run run; /* mesh (NULL: none yet), report, look and render options; mesh and look are borrowed from
                          the two below, which threads may hold longer */
    tc_held *mesh, *look;
    tc_document *document; /* never NULL */
    tc_history *history;
    tc_camera camera, home;  /* home: as it was opened */
    int width, height;       /* of the picture in the window, in pixels of the display */
    tc_histogram *histogram; /* of the field, 1024 bins over its range; NULL: not there yet */
    bool by_volume;          /* … weighted by the cells' volume: set it, then tc_loader_histogram */
    bool moving;             /* the user's hand is on something: pictures are to be there soon */
    unsigned gesture;        /* a number for it, new with each; 0: none */
    unsigned gestures;       /* so far */
    bool fresh;              /* document and camera are to be taken from what is loaded next */
    bool busy;
    int code; /* of what was read last: -1: it is there; else the exit code that render would have */
    struct {  /* while busy */
        char what[64];
        double fraction; /* below 0: not known */
    } progress;
    char said[1024]; /* the last sentence to the user; "" none */
    size_t n_listener;
    struct {
        tc_session_heard *heard;
        void *user;
    } listener[16];
} tc_session;

/* From the command line of `edit`: its options are those of `render` that make a picture, INPUT as there. Nothing is
 * read yet. argv must last. -1, or the exit code of --help and the like, or of an error that was printed. */
int tc_session_open(tc_session *session, const tc_command *command, int argc, char **argv);
/* Writes the trace. -1, or the exit code of an error that was printed. */
int tc_session_close(tc_session *session);

/* heard is called with changes until the session closes. */
void tc_session_listen(tc_session *session, tc_session_heard *heard, void *user);
/* Tells all of them. */
void tc_session_tell(tc_session *session, unsigned changes);
/* The document was edited in place: pushes it onto the history (what: "move points"; NULL: not, as selections are not)
 * and tells. While session->gesture is not 0 all of it is one step. */
void tc_session_edited(tc_session *session, const char *what);
/* A hand on something; off it again. Between them pictures are coarse. */
void tc_session_grab(tc_session *session);
void tc_session_release(tc_session *session);
void tc_session_undo(tc_session *session);
void tc_session_redo(tc_session *session);
/* Takes the place of the document, as one step. */
void tc_session_take(tc_session *session, tc_document *document, const char *what);

/* What was read: takes what run holds, which is all zeros then; settings: those that it was read by, in the place of
 * the session's, or NULL. If the session is fresh, document and camera are the run's, too, the document as one step
 * that can be undone if there was another; else the document stays, laid over the range of the field if that is a new
 * one. Called by the loader, loader.h. */
void tc_session_loaded(tc_session *session, tc_render_run *run, tc_settings *settings, tc_histogram *histogram);

/* Sets an option of `render` as if it were given on the command line ("--iso", "0.5"; "on" for a flag; several lines
 * for an option that may be given several times; text NULL: takes it away), and makes the look anew. False, and the
 * sentence in said: it cannot be, and all is as it was. Field, step and time are not set so: see loader.h. */
bool tc_session_set(tc_session *session, const char *option, const char *text);
/* Its text as it is now; NULL: not given. */
const char *tc_session_get(const tc_session *session, const char *option);

/* A sentence for the user into said, and tells. */
void tc_session_say(tc_session *session, const char *format, ...) TC_CLI_PRINTF(2, 3);
/* Another INPUT and its options in the place of what is there, argv as of tc_session_open: data, a scene, a picture
 * that carries one. Nothing is read yet: start the loader; options, document and camera become the new ones when it has
 * loaded, the document as one step that can be undone; if it cannot, all is as it was. False, and the sentence in said:
 * it cannot be, and all is as it was. */
bool tc_session_reopen(tc_session *session, int argc, char **argv);

/* The scene as JSON text that makes this picture, and the command line of `render`; from malloc, NULL when it cannot
 * be, with the sentence in said. The function goes into it as a preset. */
char *tc_session_scene(tc_session *session);
char *tc_session_command(tc_session *session);
/* The options of this picture as of a command line, function and camera among them; tc_settings_destroy ends them.
 * NULL: as above. */
tc_settings *tc_session_settings(tc_session *session);

#endif
