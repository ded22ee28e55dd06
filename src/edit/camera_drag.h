/* camera_drag.h: from moves of a pointer to cameras, as in ParaView: turn about what is looked at, shift, draw near,
 * roll. No GTK here. */
#ifndef TC_EDIT_CAMERA_DRAG_H
#define TC_EDIT_CAMERA_DRAG_H

#include "tetcast.h"

/* Turns the eye about the focal point: degrees to the right about what is up, then upwards. What is up turns along, so
 * that no pole is in the way. */
void tc_camera_orbit(tc_camera *camera, double right, double upward);
/* Moves eye and focal point, so that what lies at the focal point's depth goes along with a pointer that moves by x, y
 * pixels (y downwards) in a picture of that height. */
void tc_camera_pan(tc_camera *camera, double x, double y, int height);
/* Brings the eye nearer to the focal point, or in parallel projection makes the view smaller, by a factor above 0: 2
 * makes all twice as large. What is at x, y pixels (y downwards) from the picture's upper left corner at the focal
 * point's depth stays there; NAN: the middle. */
void tc_camera_approach(tc_camera *camera, double factor, double x, double y, int width, int height);
/* Rolls by the angle that the pointer goes about the picture's middle, from one place in it to another. */
void tc_camera_twist(tc_camera *camera, double from_x, double from_y, double to_x, double to_y, int width, int height);

/* The whole box [6] from one of its sides: axis 0 to 2 is x to z, negative: from its lower end. z is up, looking along
 * z it is y. Projection, angle and clipping stay. */
void tc_camera_stand(tc_camera *camera, int axis, bool negative, const double *bounds, double aspect);

#endif
