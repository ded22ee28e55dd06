/* layout.c: sizes, the title, and what the parts of a figure share. */
#include "figure/layout.h"

#include "figure/font.h"
#include "transfer_functions/transfer.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static const char ELLIPSIS[] = "…";

void tc_layout_range(double range[2], const tc_figure *figure)
{
    size_t n;
    const tc_knot *knot = tc_transfer_knots(figure->function, &n);
    range[0] = figure->has_range ? figure->range[0] : knot[0].s;
    range[1] = figure->has_range ? figure->range[1] : knot[n - 1].s;
}

static tc_item *add(tc_layout *l, tc_item_kind kind)
{
    assert(l->n < TC_LAYOUT_MAX);
    tc_item *item = &l->item[l->n++];
    memset(item, 0, sizeof *item);
    item->kind = kind;
    return item;
}

tc_item *tc_layout_line(tc_layout *l, double x0, double y0, double x1, double y1)
{
    tc_item *item = add(l, TC_ITEM_LINE);
    item->box = (tc_box){x0, y0, x1, y1};
    item->width = l->line;
    return item;
}

void tc_layout_take(tc_layout *l, double x0, double y0, double x1, double y1)
{
    assert((size_t)l->n_taken < sizeof l->taken / sizeof *l->taken);
    l->taken[l->n_taken++] = (tc_box){x0, y0, x1, y1};
}

bool tc_layout_blocked(const tc_layout *l, const tc_box *box)
{
    double clear = 0.25 * l->em; /* between texts; beside each other, more */
    tc_box wide = {box->x0 - 2 * clear, box->y0 - clear, box->x1 + 2 * clear, box->y1 + clear};
    if (box->x0 < 1 || box->y0 < 1 || box->x1 > l->width - 1 || box->y1 > l->height - 1)
        return true;
    for (int i = 0; i < l->n_taken; i++)
        if (tc_box_meets(box, &l->taken[i]))
            return true;
    for (int i = 0; i < l->n; i++)
        if (l->item[i].kind != TC_ITEM_LINE && tc_box_meets(&wide, &l->item[i].box))
            return true;
    return false;
}

void tc_layout_half(double half[2], const char *text, double em, bool turned)
{
    double w = 0.5 * tc_font_width(text, em), h = 0.5 * tc_font_cap(em);
    half[0] = turned ? h : w, half[1] = turned ? w : h;
}

tc_item *tc_layout_text(tc_layout *l, const char *text, double em, double x, double y, bool turned)
{
    tc_box ink;
    double half[2];
    char copy[TC_ITEM_TEXT_SIZE]; /* a cut within a character is taken back */
    size_t n = tc_font_bytes(text, TC_ITEM_TEXT_SIZE / 4 - 1);
    n = n < sizeof copy ? n : sizeof copy - 1;
    memcpy(copy, text, n);
    copy[n] = 0;
    tc_layout_half(half, copy, em, turned);
    tc_font_extent(&ink, copy, em);
    /* The baseline lies between two pixels, so that feet of letters are sharp. */
    double bx = turned ? round(x + half[0]) : x - half[0], by = turned ? y + half[1] : round(y + half[1]);
    tc_box box = turned ? (tc_box){bx + ink.y0, by - ink.x1, bx + ink.y1, by - ink.x0}
                        : (tc_box){bx + ink.x0, by + ink.y0, bx + ink.x1, by + ink.y1};
    if (!(box.x1 > box.x0) || tc_layout_blocked(l, &box))
        return NULL;
    tc_item *item = add(l, TC_ITEM_TEXT);
    item->box = box, item->em = em, item->x = bx, item->y = by, item->turned = turned;
    memcpy(item->text, copy, n + 1);
    return item;
}

double tc_layout_fit(char *out, const char *text, double em, double room)
{
    size_t most = TC_ITEM_TEXT_SIZE / 4 - 2, count = tc_font_count(text), n = count < most ? count : most;
    for (; n > 0; n--) {
        size_t bytes = tc_font_bytes(text, n);
        bool cut = n < count;
        snprintf(out, TC_ITEM_TEXT_SIZE, "%.*s%s", (int)bytes, text, cut ? ELLIPSIS : "");
        for (double size = em; size >= fmax(0.7 * em, fmin(em, 8)); size -= 1) {
            double rounded = tc_font_em(size);
            if (tc_font_width(out, rounded) <= room)
                return rounded;
        }
    }
    return 0;
}

static void lay_title(tc_layout *l)
{
    const char *title = l->figure->title;
    char text[TC_ITEM_TEXT_SIZE];
    if (!title || !*title)
        return;
    double em = tc_layout_fit(text, title, tc_font_em(1.25 * l->em), l->width - 2 * l->margin);
    double y = l->margin + 0.5 * tc_font_cap(em);
    if (em > 0 && em * 6 < l->height && tc_layout_text(l, text, em, 0.5 * l->width, y + 0.2 * em, false))
        l->top = l->margin + 1.9 * em;
    else
        tc_say(l->log, TC_WARNING, "the picture of %d x %d pixels has no room for the title \"%s\"; it is left out",
               l->width, l->height, title);
}

tc_status tc_layout_make(tc_layout *out, const tc_figure *figure, int width, int height, const tc_log *log,
                         tc_error *err)
{
    tc_layout *l = out;
    *l = (tc_layout){.width = width, .height = height, .figure = figure, .log = log};
    double size = fmin(height, 1.5 * width);
    l->em = tc_font_em(figure->text_size > 0 ? figure->text_size : fmax(10, size / 44));
    l->line = fmax(1, round(l->em / 14));
    l->gap = round(0.4 * l->em);
    l->margin = round(0.9 * l->em);
    l->top = l->margin;
    lay_title(l);
    if (figure->bar != TC_BAR_NONE)
        tc_layout_bar(l);
    tc_status status = figure->triad ? tc_layout_triad(l, err) : TC_OK;
    l->n_front = l->n;
    return status == TC_OK && figure->axes ? tc_layout_axes(l, err) : status;
}
