// camera_glm.cpp: GLM's double-precision matrices behind the C names of glm_shim.h.
#include "scene/glm_shim.h"

#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <cstring>

static glm::dvec3 vec(const double *v)
{
    return glm::dvec3(v[0], v[1], v[2]);
}

static void put(double *out, const glm::dmat4 &m)
{
    std::memcpy(out, glm::value_ptr(m), 16 * sizeof(double));
}

extern "C" void tc_glm_view(double *out, const double *forward, const double *up)
{
    put(out, glm::lookAt(glm::dvec3(0.0), vec(forward), vec(up)));
}

extern "C" void tc_glm_turn(double *out, const double *v, double degrees, const double *axis)
{
    glm::dvec3 turned = glm::dmat3(glm::rotate(glm::dmat4(1.0), glm::radians(degrees), vec(axis))) * vec(v);
    out[0] = turned.x, out[1] = turned.y, out[2] = turned.z;
}

extern "C" void tc_glm_clip(double *out, const double *projection, const double *view, const double *eye)
{
    glm::dmat4 m = glm::translate(glm::make_mat4(view), -vec(eye));
    put(out, glm::make_mat4(projection) * m);
}
