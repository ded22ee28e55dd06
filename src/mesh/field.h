/* field.h: values on a mesh beside its scalar, in the mesh's own order. */
#ifndef TC_MESH_FIELD_H
#define TC_MESH_FIELD_H

#include "mesh/mesh.h"

struct tc_field {
    uint64_t mesh_serial; /* of the mesh that it belongs to, as it was then */
    uint64_t serial;      /* its own, from tc_mesh_new_serial: who keeps something made of it compares this */
    tc_association association;
    size_t n;        /* mesh->n_vertex, or mesh->n_tet */
    double *value;   /* [n] in the order of mesh->vertex (0 at Steiner points) or of mesh->tet's real cells */
    double range[2]; /* of what is finite; 0, 0: nothing */
    bool finite;     /* all of it is */
    char *name;      /* may be NULL */
};

#endif
