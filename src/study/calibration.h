/* calibration.h: what was measured of a mesh with a transfer function, kept from run to run in a small file. */
#ifndef TC_STUDY_CALIBRATION_H
#define TC_STUDY_CALIBRATION_H

#include "mesh/mesh.h"
#include "study/candidate.h"
#include "transfer_functions/transfer.h"

/* What came with the candidates' errors and times. */
typedef struct tc_calibration {
    size_t rays;   /* that the errors are of */
    double ms;     /* that measuring them took */
    double ratio;  /* largest error of a whole picture by the calibrated one, seen so far; at least 1 */
    uint64_t view; /* that the candidates' times are of (tc_calibration_view); 0: none */
} tc_calibration;

/* All that errors depend on, as one line of text: the version, the contents of mesh, values and function, the unit
 * distance, the colour of missing values, the renderer, and what `fixed` decides of the method. The caller frees it;
 * NULL: no memory. The mesh is prepared. Cost: reads the mesh once. */
char *tc_calibration_key(const tc_mesh *mesh, const tc_transfer *tf, double unit, const char *renderer,
                         const tc_render_options *fixed);
/* What times depend on besides: camera, size and rays a pixel; never 0. */
uint64_t tc_calibration_view(const tc_camera *camera, const tc_render_options *options);

/* The folder of the cache: folder itself; where that is NULL $TETCAST_CACHE, $XDG_CACHE_HOME/tetcast or
 * $HOME/.cache/tetcast, the first that is there (relative ones of the last two are not); "" where none is. */
void tc_calibration_folder(char *out, size_t capacity, const char *folder);

/* Fills errors and times of all n candidates. False, with a debug line, where the file is not there, is damaged, is of
 * another key, or lacks a candidate; then nothing is changed. */
bool tc_calibration_load(tc_calibration *out, tc_candidate *candidate, size_t n, const char *folder, const char *key,
                         const tc_log *log);
/* Writes the file whole or not at all, making its folder; that it cannot is a debug line, no error. */
void tc_calibration_store(const tc_calibration *calibration, const tc_candidate *candidate, size_t n,
                          const char *folder, const char *key, const tc_log *log);

#endif
