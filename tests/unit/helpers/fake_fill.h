/* fake_fill.h: what test_mesh_filling.c tells the fake helper: a file of one fake_answer, n_extra doubles (coordinates
 * of points behind those of the request) and n_tet ints. */
#ifndef TC_TESTS_FAKE_FILL_H
#define TC_TESTS_FAKE_FILL_H

#include <stdint.h>

enum fake_way {
    FAKE_ANSWER, /* as written */
    FAKE_CRASH,
    FAKE_ABORT,
    FAKE_EXIT,
    FAKE_THROW,
    FAKE_SPIN,
    FAKE_SWALLOW,
    FAKE_SILENT,
    FAKE_MOVE,    /* the first point by one unit in the last place */
    FAKE_NAN,     /* the first point is none */
    FAKE_SHORT,   /* a point less */
    FAKE_CROOKED, /* two thirds of the last point */
    FAKE_TYPES,   /* tets as floats */
    FAKE_NO_TETS,
    FAKE_NO_VOLUME
};

typedef struct fake_answer {
    int64_t way, n_extra, n_tet;
    double hull_volume;
} fake_answer;

#endif
