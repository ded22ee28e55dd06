/* load.h: the mesh of one step and field after the other, the next one read while one is rendered. */
#ifndef TC_CLI_BATCH_LOAD_H
#define TC_CLI_BATCH_LOAD_H

#include "cli/input.h"

/* What is to be read: a file's step, and an array of it. Texts are borrowed. */
typedef struct tc_load {
    const char *path;
    int step;          /* in that file; -1: it has no steps */
    const char *field; /* NULL: the first array */
    int number;        /* of the step in the dataset, for messages */
} tc_load;

typedef struct tc_loader {
    tc_input_options source; /* of all */
    tc_mesh *mesh;           /* as of the load that was got last; NULL: none could be read yet */
    bool prepared;
    bool again;              /* what the mesh holds now is not told by `last`: the next one is read anyhow */
    tc_load last;
    tc_mesh_ahead *ahead;
    tc_load next;            /* that ahead reads */
    bool never_ahead;        /* memory is short */
    size_t set_up;           /* meshes that were prepared so far */
} tc_loader;

/* Reads the first load, whose mesh all others are put onto where points and cells are the same; it is not prepared yet. -1, or
 * the exit code of an error that was printed. */
int tc_loader_open(tc_loader *out, const tc_input_options *source, const tc_load *first, tc_talk *talk);
/* Puts a load onto loader->mesh, prepared; *fresh: it is another mesh than before. The same codes; after an error the loader
 * goes on with the next. */
int tc_loader_get(tc_loader *loader, bool *fresh, const tc_load *load, tc_talk *talk);
/* Begins to read a load on a thread, where this can be done; the mesh must not be changed until tc_loader_get. */
void tc_loader_begin(tc_loader *loader, const tc_load *load);
void tc_loader_finish(tc_loader *loader);

#endif
