/* paraview_xml.h: a ParaView state or camera file as what it is: proxies with properties, which hold values and lead to
 * other proxies. What any of it means is told elsewhere (paraview_state.c). */
#ifndef TC_CLI_PARAVIEW_XML_H
#define TC_CLI_PARAVIEW_XML_H

#include "cli/talk.h"

/* A place in tc_pv.text. */
typedef size_t tc_pv_text;

typedef struct tc_pv_property {
    tc_pv_text name;
    size_t first, n;           /* of tc_pv.value */
    size_t first_link, n_link; /* of tc_pv.link */
} tc_pv_property;

typedef struct tc_pv_proxy {
    tc_pv_text group, type, id;
    size_t first, n; /* of tc_pv.property */
} tc_pv_proxy;

/* What a proxy is called in a collection: "sources", "4711", "disk.ex2". */
typedef struct tc_pv_item {
    tc_pv_text collection, id, name;
} tc_pv_item;

/* All of a file. Arrays in the file's order. */
typedef struct tc_pv {
    char *text; /* all strings, each with its NUL; the first is "" */
    size_t n_text, room_text;
    tc_pv_proxy *proxy;
    size_t n_proxy, room_proxy;
    tc_pv_property *property;
    size_t n_property, room_property;
    tc_pv_text *value;
    size_t n_value, room_value;
    tc_pv_text *link; /* ids of proxies */
    size_t n_link, room_link;
    tc_pv_item *item;
    size_t n_item, room_item;
    tc_pv_text *cell; /* ids of the views in layouts, "0" for a split */
    size_t n_cell, room_cell;
    size_t n_camera;    /* camera configurations: 1 in a .pvcc, several in a file of custom viewpoints, 0 in a state */
    bool is_state;      /* it holds a ServerManagerState */
    tc_pv_text version; /* of ParaView that wrote the state */
} tc_pv;

/* Reads a file of at most 64 MiB, 64 elements deep and without a document type (so without entities to expand).
 * -1, or the exit code of an error that was printed: it names the file and the line. tc_pv_finish ends it. */
int tc_pv_read(tc_pv *out, const char *path, tc_talk *talk);
/* The same from memory; name stands in errors. */
int tc_pv_parse(tc_pv *out, const char *text, size_t length, const char *name, tc_talk *talk);
void tc_pv_finish(tc_pv *pv);

/* Of a proxy, which may be NULL: all of these then give nothing. Strings and structs are borrowed. */
const tc_pv_property *tc_pv_property_of(const tc_pv *pv, const tc_pv_proxy *proxy, const char *name);
/* How many values, or links, a property has; 0: there is none of that name. */
size_t tc_pv_values(const tc_pv *pv, const tc_pv_proxy *proxy, const char *name);
size_t tc_pv_links(const tc_pv *pv, const tc_pv_proxy *proxy, const char *name);
/* Value i of a property; "" where there is none. */
const char *tc_pv_value(const tc_pv *pv, const tc_pv_proxy *proxy, const char *name, size_t i);
/* The first n values as finite numbers; false, and out untouched, where there are fewer or one is no number. */
bool tc_pv_reals(double *out, size_t n, const tc_pv *pv, const tc_pv_proxy *proxy, const char *name);
/* Is the first value there and not 0? */
bool tc_pv_is_on(const tc_pv *pv, const tc_pv_proxy *proxy, const char *name);
/* The proxy that link i leads to; NULL: there is none. Cost: O(proxies). */
const tc_pv_proxy *tc_pv_link(const tc_pv *pv, const tc_pv_proxy *proxy, const char *name, size_t i);
const tc_pv_proxy *tc_pv_find(const tc_pv *pv, const char *id);
/* What a proxy is called in a collection (NULL: in any but helpers), else its type. */
const char *tc_pv_name(const tc_pv *pv, const tc_pv_proxy *proxy, const char *collection);
bool tc_pv_is(const tc_pv *pv, tc_pv_text text, const char *what);

#endif
