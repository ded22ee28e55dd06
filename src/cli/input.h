/* input.h: INPUT of render and info: a file, or synth:NAME[:CELLS] for a synthetic dataset without a file. */
#ifndef TC_CLI_INPUT_H
#define TC_CLI_INPUT_H

#include "cli/options.h"

typedef struct tc_input_options {
    const char *field;
    bool cell_data, point_data, has_time, has_step;
    double time;
    int step, refine;
    double idle_limit; /* seconds; 0: the default */
    bool keep_reader;  /* other steps will follow: tc_input_step */
    int reentry;        /* tc_reentry */
    size_t once_pixels; /* as of tc_prepare_options */
    int threads;
    uint64_t seed;
    bool cache;             /* beside INPUT */
    const char *cache_file; /* a file or a folder; NULL: none */
} tc_input_options;

/* Rows for a command's table whose struct has a tc_input_options named `member`. */
/* clang-format off */
#define TC_INPUT_AT(type, member, what) (offsetof(type, member) + offsetof(tc_input_options, what))
#define TC_INPUT_FIELD_ROWS(type, member)                                                                              \
    TC_INPUT_ARRAY_ROWS(type, member),                                                                                 \
    {"--time", 0, "T", "the step at or before this time", TC_OPTION_REAL, .at = TC_INPUT_AT(type, member, time),       \
     .has = TC_INPUT_AT(type, member, has_time) + 1},                                                                  \
    TC_INPUT_STEP_ROWS(type, member)
#define TC_INPUT_ARRAY_ROWS(type, member)                                                                              \
    {"--field", 0, "NAME[:COMPONENT|:magnitude]", "array to show; default the first there is", TC_OPTION_TEXT,                 \
     .at = TC_INPUT_AT(type, member, field)},                                                                          \
    {"--cell-data", 0, NULL, "the array is per cell", TC_OPTION_FLAG, .at = TC_INPUT_AT(type, member, cell_data)},     \
    {"--point-data", 0, NULL, "the array is per point; tried first when neither is given", TC_OPTION_FLAG,             \
     .at = TC_INPUT_AT(type, member, point_data)}
#define TC_INPUT_STEP_ROWS(type, member)                                                                               \
    {"--step", 0, "N", "the step by number, from 0; negative counts from the end", TC_OPTION_INT,                      \
     .at = TC_INPUT_AT(type, member, step), .has = TC_INPUT_AT(type, member, has_step) + 1},                           \
    TC_INPUT_READER_ROWS(type, member)
#define TC_INPUT_READER_ROWS(type, member)                                                                             \
    {"--refine", 0, "N", "split curved (quadratic) cells N times before they become linear; default 0", TC_OPTION_INT,         \
     .at = TC_INPUT_AT(type, member, refine), .low = 0, .high = 6},                                                    \
    {"--idle-limit", 0, "S", "stop the reader after S seconds without progress; default 60", TC_OPTION_REAL,           \
     .at = TC_INPUT_AT(type, member, idle_limit), .low = 0, .high = 1e9, .open = true}
#define TC_INPUT_GAP_ROW(type, member)                                                                                 \
    {"--reentry", 0, "auto|convexify|peel", "how rays cross gaps: fill them with cells that only lead on, or peel",    \
     TC_OPTION_CHOICE, .at = TC_INPUT_AT(type, member, reentry), .choice = tc_reentry_choice}
#define TC_INPUT_CACHE_ROWS(type, member)                                                                              \
    {"--cache", 0, NULL, "keep the prepared mesh in INPUT.tccache; with the same input and settings it is taken from there", \
     TC_OPTION_FLAG, .at = TC_INPUT_AT(type, member, cache)},                                                          \
    {"--cache-file", 0, "FILE|FOLDER", "keep it there instead; in a folder, one file for each input and its settings", \
     TC_OPTION_TEXT, .at = TC_INPUT_AT(type, member, cache_file)}
#define TC_INPUT_THREADS_ROW(type, member)                                                                             \
    {"--threads", 0, "N", "CPU threads; default all cores", TC_OPTION_INT, .at = TC_INPUT_AT(type, member, threads), .low = 1, \
     .high = 4096}
/* clang-format on */
extern const tc_choice tc_reentry_choice[];
const char *tc_reentry_name(tc_reentry reentry);

/* Pairs that exclude each other. -1 to go on, else the exit code. */
int tc_input_check(const tc_input_options *options, tc_talk *talk);

/* Reads or makes the mesh, not yet prepared. *ms_read: wall time of reading, NAN for a synthetic one.
 * -1 to go on, else the exit code of an error that was printed. */
int tc_input_load(tc_mesh **out, double *ms_read, const tc_input_options *options, const char *input, tc_talk *talk);
/* Reads the step of options onto a mesh of tc_input_load, which keeps what was prepared where its points and cells are the
 * same. *moved: they are not, and *mesh is another one, not yet prepared. The same codes. */
int tc_input_step(tc_mesh **mesh, bool *moved, double *ms_read, const tc_input_options *options, const char *input,
                  tc_talk *talk);
/* What tc_mesh_read and tc_mesh_prepare are asked for. */
tc_read_options tc_input_read_options(const tc_input_options *options);
tc_prepare_options tc_input_prepare_options(const tc_input_options *options);
bool tc_input_is_synthetic(const char *input);
/* tc_mesh_prepare with these options. The same codes. */
int tc_input_prepare(tc_mesh *mesh, const tc_input_options *options, tc_talk *talk);

/* The index in tc_synth_list of a name; -1 after printing an error that names the nearest. */
int tc_synth_index(const char *name, tc_talk *talk);

/* INPUT's file name without folders and extension ("heatsink" of synth:heatsink:5000), for default output names. */
void tc_input_stem(char *out, size_t capacity, const char *input);

#endif
