/* paraview_xml.c: ParaView's XML through expat.
 *   <ServerManagerState version="5.9.0">
 *     <Proxy group="views" type="RenderView" id="12">
 *       <Property name="ViewSize"> <Element index="0" value="400"/> … <Domain …> … </Domain> </Property>
 *       <Property name="Representations"> <Proxy value="34"/> … </Property>
 *       <Layout> <Item view="12"/> … </Layout>
 *     </Proxy>
 *     <ProxyCollection name="views"> <Item id="12" name="RenderView1"/> … </ProxyCollection>
 * in any element around it; camera files have <PVCameraConfiguration> in place of <ServerManagerState>. Proxies within
 * domains are what might be chosen, not what is. */
#include "cli/scene/paraview_xml.h"
#include "cli/options.h"

#include <errno.h>
#include <expat.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TC_PV_BYTES = 64 << 20, TC_PV_DEPTH = 64 };

/* Where the parser is. Depths count elements, the outermost is 1; 0: not in one. */
typedef struct tc_pv_reader {
    tc_pv *out;
    XML_Parser parser;
    int depth, proxy, property, layout, collection;
    tc_pv_text collection_name;
    const char *why; /* NULL: all is well */
    bool no_memory;
} tc_pv_reader;

/* ---------------------------------------------------------------------------------------------------------- arrays */

static void tc_stop(tc_pv_reader *r, const char *why)
{
    if (!r->why && !r->no_memory) {
        r->why = why;
        r->no_memory = !why;
        XML_StopParser(r->parser, XML_FALSE);
    }
}

/* Room for one more of an array; false: memory ran out. */
static bool tc_more(void **array, size_t n, size_t *room, size_t size)
{
    if (n < *room)
        return true;
    size_t wanted = *room ? 2 * *room : 64;
    void *grown = wanted <= SIZE_MAX / size ? realloc(*array, wanted * size) : NULL;
    if (!grown)
        return false;
    *array = grown;
    *room = wanted;
    return true;
}
#define MORE(r, what)                                                                                                  \
    (tc_more((void **)&(r)->out->what, (r)->out->n_##what, &(r)->out->room_##what, sizeof *(r)->out->what) ||          \
     (tc_stop(r, NULL), false))

/* Keeps a string; 0, the empty one, for NULL. */
static tc_pv_text tc_keep(tc_pv_reader *r, const char *string)
{
    tc_pv *out = r->out;
    size_t size = string ? strlen(string) + 1 : 1, at = out->n_text;
    if (size == 1 && at > 0)
        return 0;
    if (size > out->room_text - at) {
        size_t wanted = 2 * out->room_text + size + 4096;
        char *grown = realloc(out->text, wanted);
        if (!grown) {
            tc_stop(r, NULL);
            return 0;
        }
        out->text = grown;
        out->room_text = wanted;
    }
    if (string)
        memcpy(out->text + at, string, size);
    else
        out->text[at] = 0;
    out->n_text += size;
    return at;
}

static const char *tc_attribute(const XML_Char **attribute, const char *name)
{
    for (; *attribute; attribute += 2)
        if (!strcmp(attribute[0], name))
            return attribute[1];
    return NULL;
}

/* --------------------------------------------------------------------------------------------------------- elements */

static void tc_in_property(tc_pv_reader *r, const char *name, const XML_Char **attribute)
{
    tc_pv *out = r->out;
    tc_pv_property *last = &out->property[out->n_property - 1];
    if (!strcmp(name, "Element") && MORE(r, value)) {
        out->value[out->n_value++] = tc_keep(r, tc_attribute(attribute, "value"));
        last->n++;
    } else if (!strcmp(name, "Proxy") && MORE(r, link)) {
        out->link[out->n_link++] = tc_keep(r, tc_attribute(attribute, "value"));
        last->n_link++;
    }
}

static void tc_in_proxy(tc_pv_reader *r, const char *name, const XML_Char **attribute)
{
    tc_pv *out = r->out;
    if (r->layout > 0) {
        if (!strcmp(name, "Item") && MORE(r, cell))
            out->cell[out->n_cell++] = tc_keep(r, tc_attribute(attribute, "view"));
    } else if (r->depth == r->proxy + 1 && !strcmp(name, "Layout")) {
        r->layout = r->depth;
    } else if (r->depth == r->proxy + 1 && !strcmp(name, "Property") && MORE(r, property)) {
        out->property[out->n_property++] = (tc_pv_property){
            .name = tc_keep(r, tc_attribute(attribute, "name")), .first = out->n_value, .first_link = out->n_link};
        out->proxy[out->n_proxy - 1].n++;
        r->property = r->depth;
    }
}

static void XMLCALL tc_begin(void *user, const XML_Char *name, const XML_Char **attribute)
{
    tc_pv_reader *r = user;
    tc_pv *out = r->out;
    if (++r->depth > TC_PV_DEPTH) {
        tc_stop(r, "its elements lie in each other more than 64 deep");
    } else if (r->property > 0) {
        if (r->depth == r->property + 1)
            tc_in_property(r, name, attribute);
    } else if (r->proxy > 0) {
        tc_in_proxy(r, name, attribute);
    } else if (r->collection > 0) {
        if (!strcmp(name, "Item") && MORE(r, item))
            out->item[out->n_item++] = (tc_pv_item){.collection = r->collection_name,
                                                    .id = tc_keep(r, tc_attribute(attribute, "id")),
                                                    .name = tc_keep(r, tc_attribute(attribute, "name"))};
    } else if (!strcmp(name, "Proxy")) {
        if (!MORE(r, proxy))
            return;
        out->proxy[out->n_proxy++] = (tc_pv_proxy){.group = tc_keep(r, tc_attribute(attribute, "group")),
                                                   .type = tc_keep(r, tc_attribute(attribute, "type")),
                                                   .id = tc_keep(r, tc_attribute(attribute, "id")),
                                                   .first = out->n_property};
        r->proxy = r->depth;
    } else if (!strcmp(name, "ProxyCollection")) {
        r->collection_name = tc_keep(r, tc_attribute(attribute, "name"));
        r->collection = r->depth;
    } else if (!strcmp(name, "ServerManagerState")) {
        out->is_state = true;
        out->version = tc_keep(r, tc_attribute(attribute, "version"));
    } else if (!strcmp(name, "PVCameraConfiguration")) {
        out->n_camera++;
    }
}

static void XMLCALL tc_end(void *user, const XML_Char *name)
{
    tc_pv_reader *r = user;
    int *const open[] = {&r->property, &r->layout, &r->proxy, &r->collection};
    (void)name;
    for (size_t i = 0; i < sizeof open / sizeof *open; i++)
        if (*open[i] == r->depth)
            *open[i] = 0;
    r->depth--;
}

static void XMLCALL tc_doctype(void *user, const XML_Char *name, const XML_Char *system_id, const XML_Char *public_id,
                               int has_internal_subset)
{
    (void)name, (void)system_id, (void)public_id, (void)has_internal_subset;
    tc_stop(user, "it has a document type, which no file of ParaView's has");
}

/* ------------------------------------------------------------------------------------------------------------ whole */

static int tc_refuse(const tc_pv_reader *r, const char *name, tc_talk *talk)
{
    const char *why = r->why ? r->why : XML_ErrorString(XML_GetErrorCode(r->parser));
    if (r->no_memory || XML_GetErrorCode(r->parser) == XML_ERROR_NO_MEMORY)
        tc_talk_error(talk, "%s cannot be read: memory ran out", name);
    else
        tc_talk_error(talk, "%s:%lu: this is no ParaView state or camera file: %s; save it anew (File, Save State)",
                      name, (unsigned long)XML_GetCurrentLineNumber(r->parser), why);
    return TC_EXIT_FAILED;
}

static bool tc_reader_begin(tc_pv_reader *r, tc_pv *out)
{
    *out = (tc_pv){0};
    *r = (tc_pv_reader){.out = out, .parser = XML_ParserCreate(NULL)};
    if (!r->parser)
        return false;
    XML_SetUserData(r->parser, r);
    XML_SetElementHandler(r->parser, tc_begin, tc_end);
    XML_SetStartDoctypeDeclHandler(r->parser, tc_doctype);
    tc_keep(r, NULL); /* the empty string is the first one */
    return !r->no_memory;
}

static int tc_reader_end(tc_pv_reader *r, bool good, const char *name, tc_talk *talk)
{
    tc_pv *out = r->out;
    int code = -1;
    if (!good) {
        code = tc_refuse(r, name, talk);
    } else if (!out->is_state && out->n_camera == 0) {
        tc_talk_error(talk, "%s is neither a ParaView state (.pvsm) nor a camera file (.pvcc)", name);
        code = TC_EXIT_FAILED;
    }
    XML_ParserFree(r->parser);
    if (code >= 0)
        tc_pv_finish(out);
    return code;
}

int tc_pv_parse(tc_pv *out, const char *text, size_t length, const char *name, tc_talk *talk)
{
    tc_pv_reader r;
    *out = (tc_pv){0};
    if (length > TC_PV_BYTES) {
        tc_talk_error(talk, "%s is no ParaView state or camera file: it has more than 64 MiB", name);
        return TC_EXIT_FAILED;
    }
    if (!tc_reader_begin(&r, out)) {
        tc_talk_error(talk, "%s cannot be read: memory ran out", name);
        XML_ParserFree(r.parser);
        tc_pv_finish(out);
        return TC_EXIT_FAILED;
    }
    return tc_reader_end(&r, XML_Parse(r.parser, text, (int)length, XML_TRUE) == XML_STATUS_OK, name, talk);
}

int tc_pv_read(tc_pv *out, const char *path, tc_talk *talk)
{
    size_t room = 1 << 16, n = 0;
    char *text = NULL;
    int code = -1;
    *out = (tc_pv){0};
    FILE *stream = fopen(path, "rb");
    if (!stream) {
        tc_talk_error(talk, "%s cannot be read: %s%s", path, strerror(errno),
                      errno == ENOENT ? "; check the path" : "");
        return TC_EXIT_FAILED;
    }
    do {
        char *grown = realloc(text, room *= 2);
        if (!grown) {
            tc_talk_error(talk, "%s cannot be read: memory ran out", path);
            code = TC_EXIT_FAILED;
            break;
        }
        text = grown;
        n += fread(text + n, 1, room - n, stream);
    } while (n == room && n <= TC_PV_BYTES);
    if (code < 0 && ferror(stream)) {
        tc_talk_error(talk, "%s cannot be read: %s", path, strerror(errno));
        code = TC_EXIT_FAILED;
    }
    fclose(stream);
    if (code < 0)
        code = tc_pv_parse(out, text, n, path, talk);
    free(text);
    return code;
}

void tc_pv_finish(tc_pv *pv)
{
    free(pv->text);
    free(pv->proxy);
    free(pv->property);
    free(pv->value);
    free(pv->link);
    free(pv->item);
    free(pv->cell);
    *pv = (tc_pv){0};
}

/* ---------------------------------------------------------------------------------------------------------- look-up */

bool tc_pv_is(const tc_pv *pv, tc_pv_text text, const char *what)
{
    return !strcmp(pv->text + text, what);
}

const tc_pv_property *tc_pv_property_of(const tc_pv *pv, const tc_pv_proxy *proxy, const char *name)
{
    for (size_t i = 0; proxy && i < proxy->n; i++)
        if (tc_pv_is(pv, pv->property[proxy->first + i].name, name))
            return &pv->property[proxy->first + i];
    return NULL;
}

size_t tc_pv_values(const tc_pv *pv, const tc_pv_proxy *proxy, const char *name)
{
    const tc_pv_property *p = tc_pv_property_of(pv, proxy, name);
    return p ? p->n : 0;
}

size_t tc_pv_links(const tc_pv *pv, const tc_pv_proxy *proxy, const char *name)
{
    const tc_pv_property *p = tc_pv_property_of(pv, proxy, name);
    return p ? p->n_link : 0;
}

const char *tc_pv_value(const tc_pv *pv, const tc_pv_proxy *proxy, const char *name, size_t i)
{
    const tc_pv_property *p = tc_pv_property_of(pv, proxy, name);
    return p && i < p->n ? pv->text + pv->value[p->first + i] : "";
}

bool tc_pv_reals(double *out, size_t n, const tc_pv *pv, const tc_pv_proxy *proxy, const char *name)
{
    const tc_pv_property *p = tc_pv_property_of(pv, proxy, name);
    double value;
    if (!p || p->n < n)
        return false;
    for (size_t i = 0; i < n; i++)
        if (!tc_parse_real(&value, pv->text + pv->value[p->first + i]))
            return false;
    for (size_t i = 0; i < n; i++)
        tc_parse_real(&out[i], pv->text + pv->value[p->first + i]);
    return true;
}

bool tc_pv_is_on(const tc_pv *pv, const tc_pv_proxy *proxy, const char *name)
{
    double value;
    return tc_pv_reals(&value, 1, pv, proxy, name) && value != 0;
}

const tc_pv_proxy *tc_pv_find(const tc_pv *pv, const char *id)
{
    for (size_t i = 0; *id && i < pv->n_proxy; i++)
        if (tc_pv_is(pv, pv->proxy[i].id, id))
            return &pv->proxy[i];
    return NULL;
}

const tc_pv_proxy *tc_pv_link(const tc_pv *pv, const tc_pv_proxy *proxy, const char *name, size_t i)
{
    const tc_pv_property *p = tc_pv_property_of(pv, proxy, name);
    return p && i < p->n_link ? tc_pv_find(pv, pv->text + pv->link[p->first_link + i]) : NULL;
}

const char *tc_pv_name(const tc_pv *pv, const tc_pv_proxy *proxy, const char *collection)
{
    static const char helper[] = "pq_helper_proxies";
    for (size_t i = 0; proxy && i < pv->n_item; i++) {
        const tc_pv_item *item = &pv->item[i];
        const char *in = pv->text + item->collection;
        if (!strcmp(pv->text + item->id, pv->text + proxy->id) && pv->text[item->name] &&
            (collection ? !strcmp(in, collection) : strncmp(in, helper, sizeof helper - 1) != 0))
            return pv->text + item->name;
    }
    return proxy ? pv->text + proxy->type : "";
}
