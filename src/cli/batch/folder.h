/* folder.h: folders of pictures. */
#ifndef TC_CLI_BATCH_FOLDER_H
#define TC_CLI_BATCH_FOLDER_H

#include "cli/talk.h"

/* Makes the folders that a file's path leads through, where they are missing. -1, or the exit code of an error that was
 * printed. */
int tc_folders_make(const char *file, tc_talk *talk);

#endif
