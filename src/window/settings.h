/* settings.h: the options of a picture as words of a command line, kept apart from where they came from (scene,
 * picture, ParaView state, line), so that any of them can be set anew and all be checked together. No GTK here. */
#ifndef TC_WINDOW_SETTINGS_H
#define TC_WINDOW_SETTINGS_H

#include "cli/picture/render_options.h"

typedef struct tc_settings {
    size_t n;
    char **word;               /* [n], owned: "edit", INPUT, "--name=text", … */
    tc_render_command options; /* of these words; its texts point into them */
} tc_settings;

/* From a command line; argv[0] is the command's name. INPUT by its whole path where it is
 * a file. -1, or the exit code of an error that
 * was printed; *out is NULL then. trace: NULL, or gets --trace's file, which belongs to argv. */
int tc_settings_read(tc_settings **out, const char **trace, tc_talk *talk, const tc_command *command, int argc,
                     char **argv);
void tc_settings_destroy(tc_settings **settings);

/* The same with an option set to a text ("on" sets a flag), several lines of text being an option that is given several
 * times; NULL: without it. The same codes. */
int tc_settings_with(tc_settings **out, const tc_settings *settings, const char *option, const char *text,
                     tc_talk *talk, const tc_command *command);
/* The same without options, then with these instead: name and text by turns, n of each; text NULL: without it. */
int tc_settings_change(tc_settings **out, const tc_settings *settings, const char *const (*change)[2], size_t n,
                       tc_talk *talk, const tc_command *command);
/* The text of an option, the last of several; "on" or "off" of a flag; NULL: not given. Borrowed. */
const char *tc_settings_text(const tc_settings *settings, const char *option);
/* The command line of `render`, quoted for a shell; from malloc, NULL when memory is out. */
char *tc_settings_command(const tc_settings *settings);

#endif
