/* map_list.h: colour maps to choose from, built-in ones and those of preset files, each with a strip of its colours to
 * be seen by. */
#ifndef TC_EDIT_MAP_LIST_H
#define TC_EDIT_MAP_LIST_H

#include "edit/document.h"

enum { TC_MAP_STRIP = 256 };

typedef struct tc_map_entry {
    const char *name;                     /* as people read it */
    const char *text;                     /* a ParaView preset of this map alone, for tc_document_take_preset */
    const char *file;                     /* that it is from; NULL: a built-in one */
    bool has_opacity;                     /* taking it takes its curve, too */
    unsigned char strip[TC_MAP_STRIP][3]; /* red, green, blue from its lower to its upper end */
    float opacity[TC_MAP_STRIP];          /* likewise, of 1: the largest of it; where has_opacity is set */
} tc_map_entry;

typedef struct tc_map_list {
    size_t n;
    tc_map_entry *entry; /* [n] */
    void *owned[2];      /* what the texts lie in */
} tc_map_list;

/* The maps of a file of ParaView presets (.json, .xml), or of the text of one; NULL: the built-in ones. Those that come
 * twice, name and all, are in it once. Errors: as tc_transfer_presets; *out is NULL then. Cost: reads the file once,
 * about 0.1 ms a map; of any thread. */
tc_status tc_map_list_read(tc_map_list **out, const char *file, tc_error *err);
void tc_map_list_destroy(tc_map_list **list);

/* Does each word of the search stand in the map's name or its file's, without regard to case? None does always. */
bool tc_map_matches(const tc_map_entry *entry, const char *search);

/* The function's colours in the middles of n equal parts of its knots' range, and its attenuation; opacity may be NULL.
 */
void tc_map_strip(unsigned char (*rgb)[3], float *opacity, size_t n, const tc_transfer *tf);

#endif
