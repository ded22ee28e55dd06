/* glm_shim.h: the few GLM operations that the camera needs, behind C names. Double precision, column-major as GL. */
#ifndef TC_SCENE_GLM_SHIM_H
#define TC_SCENE_GLM_SHIM_H

#ifdef __cplusplus
extern "C" {
#endif

/* Rotation from world to view axes (rows right, up, back) of an eye that looks along `forward`.
 *   out [16] column-major, no translation; forward [3] unit; up [3] not parallel to forward. */
void tc_glm_view(double *out, const double *forward, const double *up);
/* out = v [3] turned by degrees about axis [3] (not zero, need not be unit), right-handed. out may be v. */
void tc_glm_turn(double *out, const double *v, double degrees, const double *axis);
/* out = projection * view * translation(-eye); all matrices [16]; out may be either. */
void tc_glm_clip(double *out, const double *projection, const double *view, const double *eye);

#ifdef __cplusplus
}
#endif
#endif
