/* file_kind.c: what a file that is opened or dropped is to the window. */
#include "window/file_kind.h"

#include "cli/scene/paraview.h"
#include "cli/scene/scene_file.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

static bool ends_in(const char *path, const char *end)
{
    const size_t n = strlen(path), e = strlen(end);
    return n > e && strcasecmp(path + n - e, end) == 0;
}

static bool holds_maps(const char *path)
{
    tc_text_pair *map;
    size_t n;
    const tc_status status = tc_transfer_presets(&map, &n, path, NULL);
    free(map);
    return status == TC_OK;
}

tc_file_kind tc_file_kind_of(const char *path)
{
    if (tc_input_is_picture(path))
        return TC_FILE_PICTURE;
    if (tc_input_is_paraview(path))
        return TC_FILE_SCENE;
    if ((ends_in(path, ".json") || ends_in(path, ".xml")) && holds_maps(path))
        return TC_FILE_PRESET;
    return tc_input_is_scene(path) ? TC_FILE_SCENE : TC_FILE_DATA;
}
