/* read.h: asking tetcast-read for a step, and taking what it answered: the two halves of tc_mesh_read and
 * tc_mesh_read_values, which ahead.c runs on different threads. */
#ifndef TC_READERS_READ_H
#define TC_READERS_READ_H

#include "core/worker.h"
#include "mesh/mesh.h"

/* What every call checks first. Errors: TC_E_ARG. */
tc_status tc_read_check(const tc_read_options *options, tc_error *err);

/* An object of what options ask for of path, "do" being `what`; to be given back with json_decref.
 * Errors: TC_E_FILE, TC_E_ARG (a name that is not UTF-8), TC_E_MEMORY. */
tc_status tc_read_request(json_t **out, const char *what, const char *path, const tc_read_options *options,
                          tc_error *err);

/* Sends a request about path to *worker, which is started where it is NULL, and stopped where it cannot go on. *reply
 * is to be finished, whatever the result. Errors: as tc_worker_call. */
tc_status tc_read_call(tc_reply *reply, tc_worker **worker, json_t *request, const char *path,
                       const tc_read_options *options, const tc_log *log, tc_error *err);

/* Asks for a step; as tc_read_call.
 *   keep   more requests follow
 *   known  the hash of a mesh whose values alone are wanted; 0: points and cells, too
 *   ms     gets the milliseconds it took; may be NULL */
tc_status tc_read_ask(tc_reply *reply, double *ms, tc_worker **worker, const char *path, const tc_read_options *options,
                      bool keep, uint64_t known, const tc_log *log, tc_error *err);

/* Does the reply hold values alone, for the mesh whose hash was sent? */
bool tc_read_is_same(const tc_reply *reply);
/* The step that a reply is of; -1: the file has none. */
int tc_read_step(const tc_reply *reply);

/* The mesh of a reply with points and cells, as tc_mesh_read gives it but without a reader; ms: of asking. */
tc_status tc_read_make_mesh(tc_mesh **out, const char *path, const tc_reply *reply, double ms, tc_error *err);

/* The values of a reply, which lie in its mapping; *association is of them. NULL with TC_OK: the file has no field.
 * Errors: TC_E_WORKER (they are not as many as the mesh's points or cells). */
tc_status tc_read_values_of(const double **out, tc_association *association, const tc_reply *reply, size_t n_vertex,
                            size_t n_tet, tc_error *err);

/* Puts the values of a reply onto the mesh they belong to, and its source; on failure it is as it was.
 * Errors: as tc_mesh_set_scalar. */
tc_status tc_read_take_values(tc_mesh *mesh, const char *path, const tc_reply *reply, double ms, tc_error *err);

/* TC_E_MOVED, with its sentence. */
tc_status tc_read_fail_moved(const char *path, int step, tc_error *err);

/* Waits for what reads ahead for this mesh (tc_mesh_ahead_begin), which then gives its reader back. */
void tc_read_wait(tc_mesh *mesh);

#endif
