/* font.h: outlines of letters (glyphs.inc), aligned to whole pixels from below and above. */
#ifndef TC_FIGURE_FONT_H
#define TC_FIGURE_FONT_H

#include "figure/fill.h"

/* em rounded so that capitals and digits are a whole number of pixels high. */
double tc_font_em(double em);
/* Height of capitals and digits, in pixels; whole for a rounded em. */
double tc_font_cap(double em);
/* Advance of a text, in pixels. */
double tc_font_width(const char *text, double em);
/* Where a text that starts at (0, 0) has ink, y down; all 0 where it has none. */
void tc_font_extent(tc_box *out, const char *text, double em);
/* Adds the outlines of a text whose baseline starts at (x, y), y down; turned: written upwards, from (x, y) up.
 * false: memory is out. Broken UTF-8 and characters that the font lacks become U+FFFD, control characters blanks. */
bool tc_font_add(tc_path *path, const char *text, double em, double x, double y, bool turned);
/* Number of characters, and length in bytes of the first n of them. */
size_t tc_font_count(const char *text);
size_t tc_font_bytes(const char *text, size_t n);

#endif
