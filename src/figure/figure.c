/* figure.c: checks what is asked for, chooses the ink, lays out, paints. */
#include "core/memory.h"
#include "figure/layout.h"
#include "figure/paint.h"

#include <math.h>
#include <stdlib.h>

tc_status tc_figure_check_box(const double *bounds, tc_error *err)
{
    for (int i = 0; i < 3; i++) {
        double lo = bounds[2 * i], hi = bounds[2 * i + 1];
        if (!(isfinite(lo) && isfinite(hi) && lo <= hi))
            return tc_fail(err, TC_E_ARG, "%g to %g in %c is no side of a box; bounds must be finite, the lower first",
                           lo, hi, "xyz"[i]);
    }
    return TC_OK;
}

tc_status tc_figure_check(const tc_figure *f, tc_error *err)
{
    if (f->ink < TC_INK_AUTO || f->ink > TC_INK_LIGHT || f->bar < TC_BAR_NONE || f->bar > TC_BAR_BOTTOM)
        return tc_fail(err, TC_E_ARG, "a figure's ink %d or colour bar %d is none of those there are", (int)f->ink,
                       (int)f->bar);
    if (f->text_size != 0 && !(f->text_size >= 4 && f->text_size <= 1000))
        return tc_fail(err, TC_E_ARG,
                       "letters of %g pixels cannot be drawn; 4 to 1000 can, and 0 lets the picture decide",
                       f->text_size);
    if ((f->axes || f->triad) && !f->camera)
        return tc_fail(err, TC_E_ARG, "axes and a triad need the camera that the picture was made with");
    if (f->axes && !f->bounds)
        return tc_fail(err, TC_E_ARG, "axes need the bounds of the box that they are of");
    tc_status status = f->axes ? tc_figure_check_box(f->bounds, err) : TC_OK;
    if (status != TC_OK || f->bar == TC_BAR_NONE)
        return status;
    if (!f->function)
        return tc_fail(err, TC_E_ARG, "a colour bar needs the transfer function whose colours it shows");
    if (f->n_category > 0 && !f->category)
        return tc_fail(err, TC_E_ARG, "a colour bar of %zu categories needs their values", f->n_category);
    for (size_t i = 0; i < f->n_category; i++)
        if (!isfinite(f->category[i]))
            return tc_fail(err, TC_E_ARG, "category %zu of a colour bar is not finite", i);
    if (f->n_category > 0)
        return TC_OK;
    double range[2];
    tc_layout_range(range, f);
    if (!(isfinite(range[0]) && isfinite(range[1]) && range[0] <= range[1]))
        return tc_fail(err, TC_E_ARG, "a colour bar cannot span %g to %g; give a finite range, the lower end first",
                       range[0], range[1]);
    if (f->log && !(range[0] > 0))
        return tc_fail(err, TC_E_ARG, "a logarithmic colour bar needs a range above 0, not %g to %g", range[0],
                       range[1]);
    return TC_OK;
}

/* Is what letters stand on dark? That of the outermost thirtieth of the picture, over white. */
static bool is_dark(const tc_image *image)
{
    int w = image->width, h = image->height, rim = 1 + (w < h ? w : h) / 30;
    double sum = 0;
    size_t n = 0;
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++) {
            if (x == rim && y >= rim && y < h - rim && w > 2 * rim)
                x = w - rim;
            const float *p = image->rgba + 4 * ((size_t)y * (size_t)w + (size_t)x);
            double gray = 0.299 * p[0] + 0.587 * p[1] + 0.114 * p[2] + 1 - p[3];
            if (isfinite(gray))
                sum += fmin(fmax(gray, 0), 1), n++;
        }
    return n > 0 && sum < 0.5 * (double)n;
}

tc_ink tc_figure_ink(const tc_image *image)
{
    return is_dark(image) ? TC_INK_LIGHT : TC_INK_DARK;
}

/* Does the image lie within the picture that it is a part of? */
static tc_status check_part(const tc_image *image, const tc_figure *f, tc_error *err)
{
    if (f->whole_width == 0 && f->whole_height == 0 && f->part_x == 0 && f->part_y == 0)
        return TC_OK;
    if (f->whole_width < 1 || f->whole_height < 1 || f->part_x < 0 || f->part_y < 0 ||
        f->part_x > f->whole_width - image->width || f->part_y > f->whole_height - image->height)
        return tc_fail(err, TC_E_ARG, "a part of %dx%d pixels at %d,%d does not lie within a picture of %dx%d",
                       image->width, image->height, f->part_x, f->part_y, f->whole_width, f->whole_height);
    if (f->ink == TC_INK_AUTO)
        return tc_fail(err, TC_E_ARG,
                       "the ink of a figure cannot be measured in a part of its picture; give it dark or light ink");
    return TC_OK;
}

tc_status tc_figure_draw(tc_image *image, const tc_figure *figure, const tc_log *log, tc_error *err)
{
    if (!image || !image->rgba || image->width < 1 || image->height < 1)
        return tc_fail(err, TC_E_ARG, "a figure needs a picture to be drawn over");
    tc_status status = tc_figure_check(figure, err);
    if (status == TC_OK)
        status = check_part(image, figure, err);
    if (status != TC_OK)
        return status;
    const bool part = figure->whole_width > 0;
    tc_layout *layout = tc_alloc(1, sizeof *layout);
    if (!layout)
        return tc_fail_memory(err, "a figure", 1, sizeof *layout);
    status = tc_layout_make(layout, figure, part ? figure->whole_width : image->width,
                            part ? figure->whole_height : image->height, log, err);
    if (status == TC_OK)
        status = tc_figure_paint(image, layout,
                                 figure->ink == TC_INK_AUTO ? is_dark(image) : figure->ink == TC_INK_LIGHT, err);
    free(layout);
    return status;
}
