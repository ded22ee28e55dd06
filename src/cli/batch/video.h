/* video.h: finished pictures become a video, by ffmpeg where it is installed. */
#ifndef TC_CLI_BATCH_VIDEO_H
#define TC_CLI_BATCH_VIDEO_H

#include "tetcast.h"

typedef struct tc_video_options {
    double fps;  /* pictures a second, 0.01 to 1000, to three digits after the point; 0: 24 */
    int quality; /* 1 to 100, for the constant rate factor of the encoder; 0: 75, which looks like the pictures */
    /* Called before each frame is handed over, and while ffmpeg is waited for; false: stop. NULL: nothing. */
    bool (*go_on)(void *user, size_t frame, size_t n);
    void *user;
} tc_video_options;

/* Does the name end in that of a video that can be made: .mp4, .mov, .webm, .gif, in any capitals? */
bool tc_video_is_name(const char *path);

/* Is ffmpeg found in PATH? Ask before a long run. If not, *why (may be NULL) says how to get it. */
bool tc_video_is_possible(char *why, size_t capacity);

/* Makes the video `path` of n pictures in their order: PNG files or JPEG files, all of one size, with any names.
 *   .mp4 .mov  H.264, 4:2:0, BT.709; the constant rate factor is 42 - 0.32 quality
 *   .webm      VP9, 4:2:0, BT.709; 60 - 0.45 quality; transparency is kept
 *   .gif       256 colours of its own for each frame; times in hundredths of a second; plays for ever
 * Elsewhere what is transparent stands on white. Where an encoder wants even sizes and the pictures' are not, the last
 * column or row is there twice. The same pictures give the same bytes with the same ffmpeg: no dates, no names. The
 * file appears whole or not at all (.NAME.part beside it meanwhile, which a killed run leaves and the next one takes).
 * Errors: TC_E_WORKER (no ffmpeg: the sentence says how to get it; ffmpeg failed: its last line), TC_E_FILE (a picture
 * is missing, cut, of another kind or size; the video cannot be written, or is being written by another process),
 * TC_E_ARG, TC_E_MEMORY, TC_E_CANCEL (go_on said so). No picture is changed. */
tc_status tc_video_make(const char *path, const char *const *frame, size_t n, const tc_video_options *options,
                        tc_error *err);

#endif
