/* paraview.h: a ParaView state (.pvsm) or camera file (.pvcc) as a scene with the keys of scene_file.h, as far as it
 * describes a volume view (docs/formats.md, "ParaView states"). */
#ifndef TC_CLI_PARAVIEW_H
#define TC_CLI_PARAVIEW_H

#include "cli/scene/paraview_xml.h"
#include "cli/scene/scene_file.h"

#include <jansson.h>

/* What was not understood, left out or taken otherwise, each a clause without the file's name. */
typedef struct tc_paraview_notes {
    size_t n;
    char **line; /* [n], owned */
} tc_paraview_notes;

/* The scene of a file: "data" (with wants_data), "field", "point_data" or "cell_data", "time", "camera",
 * "transfer_function", "effects" (a maximum intensity projection), "output" (size, background), and, of an animated
 * camera, "views" ({"path": […], "along": "time"}) and, with wants_data, of several files "series", all of them that are
 * there: both for many pictures.
 *   scene      made by the call, the caller's
 *   notes      in any case to be ended by tc_paraview_notes_finish
 *   wants_data the file's data are the INPUT: the path leads from the current folder, and is there
 * -1, or the exit code of an error that was printed: unreadable, no state or camera file, no render view, its data are
 * not there. */
int tc_paraview_read(json_t **scene, tc_paraview_notes *notes, const char *path, bool wants_data, tc_talk *talk);
/* The same from what was read of the file at path. */
int tc_paraview_scene(json_t **scene, tc_paraview_notes *notes, const tc_pv *pv, const char *path, bool wants_data,
                      tc_talk *talk);

/* The scene of a file as options of a command; what is noted is printed as warnings, with `silent` not. A camera's path
 * ("views") is left aside, and noted where the command makes no several pictures. The same codes. */
int tc_paraview_options(tc_scene *out, const char *path, bool wants_data, bool silent, const tc_command *command,
                        tc_talk *talk);

/* What many pictures are made of: *views, a new reference, NULL: its camera does not move; with data not NULL also *data,
 * a text or, of several files, a list of them. Notes are not printed. The same codes. */
int tc_paraview_many(json_t **data, json_t **views, const char *path, tc_talk *talk);

/* One more; drops it when memory is out. */
void tc_paraview_note(tc_paraview_notes *notes, const char *format, ...) TC_CLI_PRINTF(2, 3);
/* Prints them as warnings, a line each. */
void tc_paraview_notes_say(const tc_paraview_notes *notes, const char *path, tc_talk *talk);
void tc_paraview_notes_finish(tc_paraview_notes *notes);

/* Is this the name of a ParaView state (.pvsm), or of a camera file (.pvcc, .pvcvbc)? */
bool tc_input_is_paraview(const char *input);
bool tc_is_paraview_camera(const char *path);

#endif
