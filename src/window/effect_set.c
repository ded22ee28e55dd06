/* effect_set.c: options set from controls. */
#include "window/effect_set.h"

#include "window/control.h"

#include <string.h>

enum { TC_REST_MS = 200 };

void tc_effect_hub_init(tc_effect_hub *hub, tc_session *session)
{
    *hub = (tc_effect_hub){.session = session, .kept = g_hash_table_new_full(g_str_hash, g_str_equal, NULL, g_free)};
}

void tc_effect_hub_finish(tc_effect_hub *hub)
{
    if (hub->resting)
        g_source_remove(hub->resting);
    hub->resting = 0;
    g_clear_pointer(&hub->kept, g_hash_table_unref);
}

char *tc_effect_text(const tc_session *session, const char *option)
{
    const tc_given_list *given = &session->options.given;
    GString *text = NULL;
    for (size_t i = 0; i < given->n; i++) {
        const tc_given *one = &given->item[i];
        if (strcmp(one->option->name, option) != 0)
            continue;
        const char *value = one->text ? one->text : "1"; /* an optional value: its greatest */
        if (!text || !one->option->repeat) {
            if (text)
                g_string_free(text, TRUE);
            text = g_string_new(value);
        } else {
            g_string_append_printf(text, "\n%s", value);
        }
    }
    if (!text)
        return NULL;
    if (!strcmp(text->str, "off") && !tc_is_given(given, option)) {
        g_string_free(text, TRUE);
        return NULL;
    }
    return g_string_free(text, FALSE);
}

/* Is one of those that it needs given, but for `without`? */
static bool tc_is_met(const tc_session *session, const char *option, const char *without)
{
    size_t n;
    const char *const *need = tc_control_needs(&n, option);
    for (size_t i = 0; i < n; i++) {
        const bool counts = !without || strcmp(need[i], without) != 0;
        char *text = counts ? tc_effect_text(session, need[i]) : NULL;
        const bool given = text && strcmp(text, "off") != 0;
        g_free(text);
        if (given)
            return true;
    }
    return n == 0;
}

bool tc_effect_can(const tc_effect_hub *hub, const char *option)
{
    return tc_is_met(hub->session, option, NULL);
}

bool tc_effect_set(tc_effect_hub *hub, const char *option, const char *text)
{
    const char *other;
    const bool off = !text || !strcmp(text, "off");
    for (size_t i = 0; off && (other = tc_control_dependent(i)); i++) {
        char *has = tc_effect_text(hub->session, other);
        if (has && !tc_is_met(hub->session, other, option) && tc_session_set(hub->session, other, NULL))
            g_hash_table_replace(hub->kept, (gpointer)other, g_strdup(has));
        g_free(has);
    }
    const bool done = tc_session_set(hub->session, option, off ? NULL : text);
    for (size_t i = 0; (other = tc_control_dependent(i)); i++) {
        const char *kept = g_hash_table_lookup(hub->kept, other);
        if (kept && tc_effect_can(hub, other) && tc_session_set(hub->session, other, kept))
            g_hash_table_remove(hub->kept, other);
    }
    return done;
}

static gboolean tc_effect_rests(gpointer user)
{
    tc_effect_hub *hub = user;
    hub->resting = 0;
    tc_session_release(hub->session);
    return G_SOURCE_REMOVE;
}

void tc_effect_moves(tc_effect_hub *hub)
{
    if (hub->resting)
        g_source_remove(hub->resting);
    else
        tc_session_grab(hub->session);
    hub->resting = g_timeout_add(TC_REST_MS, tc_effect_rests, hub);
}
