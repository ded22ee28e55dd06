/* render_choose.h: --error and --frame-time: settings by what they give instead of by name. */
#ifndef TC_CLI_RENDER_CHOOSE_H
#define TC_CLI_RENDER_CHOOSE_H

#include "cli/picture/render_report.h"

/* Chooses run->render's knobs; fills run->choice and says why. -1 to go on, else the exit code of an error that was
 * printed. */
int tc_choice_make(tc_render_run *run, tc_renderer *renderer, tc_talk *talk);
/* After the last frame: what was verified while choosing is of this picture, too. Says with which confidence, where
 * --verify does not. */
void tc_choice_take_verify(tc_render_run *run, tc_talk *talk);
/* Is the picture, as far as it was verified, within the error that was asked for? -1, or the exit code of the error
 * that was printed. */
int tc_choice_judge(const tc_render_run *run, tc_talk *talk);

/* "choice" of the statistics file and of the image; NULL where nothing was chosen. New reference. */
json_t *tc_choice_json(const tc_render_run *run);

#endif
