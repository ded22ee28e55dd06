/* scene_file.h: a scene as JSON: each key mirrors an option of `render` (docs/formats.md). */
#ifndef TC_CLI_SCENE_FILE_H
#define TC_CLI_SCENE_FILE_H

#include "cli/options.h"

#include <jansson.h>

/* What an option's text names. */
typedef enum tc_scene_path {
    TC_PATH_NONE = 0,
    TC_PATH_FILE,   /* a file; "-" is none */
    TC_PATH_MAYBE,  /* a file, if there is one of that name, else something else */
    TC_PATH_OPACITY /* FILE[,OPACITY] */
} tc_scene_path;

/* What a key is about. */
typedef enum tc_scene_role {
    TC_KEY_RUN = 0,     /* how a run goes */
    TC_KEY_PICTURE = 1, /* it makes the picture what it is, and goes into its metadata */
    TC_KEY_BATCH = 2    /* of `batch` alone: other commands pass it over */
} tc_scene_role;

/* One key of a scene file. */
typedef struct tc_scene_key {
    const char *section; /* "camera"; "": the scene itself */
    const char *key;     /* "position" */
    const char *option;  /* "--camera-position"; NULL: not in this version */
    tc_scene_path path;
    tc_scene_role role;
} tc_scene_key;

/* All keys but "data"; *n gets their count. Static memory. */
const tc_scene_key *tc_scene_keys(size_t *n);

/* One option of a scene: its text as of a command line, paths led from the scene's folder. */
typedef struct tc_scene_item {
    const tc_option *option;
    char *called; /* "scene.json:12: camera.position" */
    char *text;   /* as tc_option_set takes it; NULL: an optional value is left out */
} tc_scene_item;

typedef struct tc_scene {
    char *data; /* INPUT; NULL: the scene names none */
    size_t n;
    tc_scene_item *item; /* [n] in the file's order */
} tc_scene;

/* The scene in `text`; name stands in errors. folder: paths that are not absolute lead from there; NULL or "": from the
 * current one. -1, or the exit code of an error that was printed: it names line, key and the nearest key. */
int tc_scene_parse(tc_scene *out, const char *text, const char *name, const char *folder, const tc_command *command,
                   tc_talk *talk);
/* The text of a scene's file, from malloc, as an object in *json: JSON, or a picture that carries one. The same codes. */
int tc_scene_load(json_t **json, char **text, const char *path, tc_talk *talk);
/* The folder that a scene's paths lead from, from malloc; NULL: the current one, as of a picture. False: memory ran out. */
bool tc_scene_folder(char **folder, const char *path);
/* A path that leads from that folder (NULL or "": the current one), if it is not absolute; from malloc; NULL: memory ran out. */
char *tc_scene_path_from(const char *folder, const char *path);
/* As tc_scene_parse, of an object; text is the file's, NULL: errors name no line. element: of the text's list of transfer functions the one that is in
 * json; -1: it is no list. */
int tc_scene_from_json(tc_scene *out, json_t *json, int element, const char *text, const char *name, const char *folder,
                  const tc_command *command, tc_talk *talk);
/* The scene in a file: JSON, or a picture that carries one. The same codes. */
int tc_scene_read(tc_scene *out, const char *path, const tc_command *command, tc_talk *talk);
void tc_scene_finish(tc_scene *scene);

/* Of TC_PATH_MAYBE: is it a file that is there, and not the name of a built-in map or of a kind of opacity? */
bool tc_names_file(const char *text);

/* Is this INPUT a scene file or a picture, by its extension? */
bool tc_input_is_scene(const char *input);
bool tc_input_is_picture(const char *input);

#endif
