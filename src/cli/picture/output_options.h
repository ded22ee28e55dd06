/* output_options.h: options of how a picture's files hold what was rendered. */
#ifndef TC_CLI_OUTPUT_OPTIONS_H
#define TC_CLI_OUTPUT_OPTIONS_H

#include "cli/options.h"

typedef struct tc_output_options {
    int png_level;    /* 0 … 9; -1: the default */
    int jpeg_quality; /* 0: the default */
    int bits;         /* 0: the format's default */
    bool depth, value;
    int stereo;       /* tc_stereo, stereo_options.h */
    double eye_angle; /* degrees */
} tc_output_options;

/* Rows for a command's table whose struct has a tc_output_options named `member`. */
/* clang-format off */
#define TC_OUTPUT_AT(type, member, what) .at = offsetof(type, member) + offsetof(tc_output_options, what)
#define TC_OUTPUT_ROWS(type, member)                                                                                   \
    {"--png-level", 0, "N", "zlib's level, 0 (large, quick) to 9 (small, slow); default runs alone", TC_OPTION_INT,   \
     TC_OUTPUT_AT(type, member, png_level), .low = 0, .high = 9},                                                      \
    {"--jpeg-quality", 0, "N", "1 to 100; default 95", TC_OPTION_INT, TC_OUTPUT_AT(type, member, jpeg_quality),        \
     .low = 1, .high = 100},                                                                                           \
    {"--bits", 0, "8|16|32", "a channel: png 8 or 16, exr 16 or 32", TC_OPTION_CHOICE,                                 \
     TC_OUTPUT_AT(type, member, bits), .choice = tc_bits_choice},                                                      \
    {"--depth", 0, NULL, "also the depth at which a ray has gathered an opacity of 1/2, along the view in the mesh's unit: exr gets a channel Z, others NAME_depth.exr beside them", TC_OPTION_FLAG, \
     TC_OUTPUT_AT(type, member, depth)},                                                                               \
    {"--value", 0, NULL, "also the scalar at that depth, in NAME_value.exr", TC_OPTION_FLAG, TC_OUTPUT_AT(type, member, value)}, \
    {"--stereo", 0, "none|pair|side-by-side|top-bottom|anaglyph", "for two eyes: NAME_left and NAME_right ({eye} in a name); one picture of twice the width or height; or red for the left, cyan for the right eye", TC_OPTION_CHOICE, \
     TC_OUTPUT_AT(type, member, stereo), .choice = tc_stereo_choice},                                                  \
    {"--eye-angle", 0, "DEG", "between the eyes, as seen from the focal point; default 2", TC_OPTION_REAL,             \
     TC_OUTPUT_AT(type, member, eye_angle), .low = 0, .high = 90, .open = true}
/* clang-format on */
extern const tc_choice tc_bits_choice[], tc_stereo_choice[];

/* What is asked for, for a file of this name; depth NULL. */
tc_image_encoding tc_output_encoding(const tc_output_options *options, const char *path);
/* Can a file of this name be written so? "" in why [160]: yes; else a sentence. */
void tc_output_wrong(char *why, const tc_output_options *options, const char *path);

#endif
