/* paint.h: from a layout to pixels. */
#ifndef TC_FIGURE_PAINT_H
#define TC_FIGURE_PAINT_H

#include "figure/layout.h"

/* image: the picture of the layout, or the part of it that the figure says. light: light letters. Errors: TC_E_MEMORY, with a part of the figure drawn. */
tc_status tc_figure_paint(tc_image *image, const tc_layout *layout, bool light, tc_error *err);

#endif
