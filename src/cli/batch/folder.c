/* folder.c: folders of pictures. */
#define _POSIX_C_SOURCE 200809L
#include "cli/batch/folder.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

int tc_folders_make(const char *file, tc_talk *talk)
{
    char *path = strdup(file);
    int code = -1;
    if (!path) {
        tc_talk_error(talk, "memory ran out");
        return TC_EXIT_FAILED;
    }
    for (char *c = strchr(path + 1, '/'); c && code < 0; c = strchr(c + 1, '/')) {
        struct stat info;
        *c = 0;
        if (mkdir(path, 0777) != 0 && errno != EEXIST && errno != EISDIR) {
            tc_talk_error(talk, "the folder %s for the pictures cannot be made: %s; make it, or give --output another name",
                          path, strerror(errno));
            code = TC_EXIT_FAILED;
        } else if (stat(path, &info) == 0 && !S_ISDIR(info.st_mode)) {
            tc_talk_error(talk, "%s is a file, so it cannot be a folder of pictures: give --output another name", path);
            code = TC_EXIT_FAILED;
        }
        *c = '/';
    }
    free(path);
    return code;
}
