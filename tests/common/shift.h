/* shift.h: rays beside a ray: what says something only about one of them says nothing. */
#ifndef TC_TESTS_COMMON_SHIFT_H
#define TC_TESTS_COMMON_SHIFT_H

/* To the four sides and the four corners between them. */
enum { RAY_SIDES = 8 };
/* What moves a ray as much as rounding to float may, in diagonals. */
#define RAY_SHIFT 0x1p-22

/* The origin moved across direction (unit length) to side 0 … RAY_SIDES - 1 by `by` (at corners by it along both axes).
 */
void ray_shift(double moved[3], const double origin[3], const double direction[3], double by, int side);

#endif
