/* color_space.c: interpolation between two colours in ParaView's colour spaces.
 * Lab: CIE 1976 with D65 and the sRGB curve (IEC 61966-2-1); Diverging: K. Moreland, Diverging Color Maps for
 * Scientific Visualization, 2009 (Msh: polar Lab); midpoint and sharpness: the modified Hermite curve of
 * vtkPiecewiseFunction. */
#include "transfer_functions/color_space.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

/* ------------------------------------------------------------------------------------------------------ spaces */

static double linear_of_srgb(double v)
{
    return v > 0.04045 ? pow((v + 0.055) / 1.055, 2.4) : v / 12.92;
}

static double srgb_of_linear(double v)
{
    return v > 0.0031308 ? 1.055 * pow(v, 1 / 2.4) - 0.055 : 12.92 * v;
}

static const double white[3] = {0.9505, 1.0, 1.089};

void tc_color_rgb_to_lab(double lab[3], const double rgb[3])
{
    static const double matrix[3][3] = {{0.4124, 0.3576, 0.1805}, {0.2126, 0.7152, 0.0722}, {0.0193, 0.1192, 0.9505}};
    double f[3];
    for (int i = 0; i < 3; i++) {
        double v = 0;
        for (int c = 0; c < 3; c++)
            v += matrix[i][c] * linear_of_srgb(rgb[c]);
        v /= white[i];
        f[i] = v > 0.008856 ? cbrt(v) : 7.787 * v + 16.0 / 116;
    }
    lab[0] = 116 * f[1] - 16;
    lab[1] = 500 * (f[0] - f[1]);
    lab[2] = 200 * (f[1] - f[2]);
}

void tc_color_lab_to_rgb(double rgb[3], const double lab[3])
{
    static const double matrix[3][3] = {
        {3.2406, -1.5372, -0.4986}, {-0.9689, 1.8758, 0.0415}, {0.0557, -0.2040, 1.0570}};
    const double y = (lab[0] + 16) / 116, f[3] = {lab[1] / 500 + y, y, y - lab[2] / 200};
    double xyz[3], largest = 1;
    for (int i = 0; i < 3; i++) {
        const double cube = f[i] * f[i] * f[i];
        xyz[i] = white[i] * (cube > 0.008856 ? cube : (f[i] - 16.0 / 116) / 7.787);
    }
    for (int c = 0; c < 3; c++) {
        rgb[c] = srgb_of_linear(matrix[c][0] * xyz[0] + matrix[c][1] * xyz[1] + matrix[c][2] * xyz[2]);
        largest = fmax(largest, rgb[c]);
    }
    for (int c = 0; c < 3; c++) /* too bright: darker, of the same hue; below black: cut off */
        rgb[c] = fmax(rgb[c] / largest, 0);
}

static void rgb_to_hsv(double hsv[3], const double rgb[3])
{
    const double high = fmax(rgb[0], fmax(rgb[1], rgb[2])), low = fmin(rgb[0], fmin(rgb[1], rgb[2]));
    const double spread = high - low;
    hsv[2] = high;
    hsv[1] = high > 0 ? spread / high : 0;
    hsv[0] = 0;
    if (hsv[1] > 0) {
        if (rgb[0] == high)
            hsv[0] = (rgb[1] - rgb[2]) / spread / 6;
        else if (rgb[1] == high)
            hsv[0] = 1.0 / 3 + (rgb[2] - rgb[0]) / spread / 6;
        else
            hsv[0] = 2.0 / 3 + (rgb[0] - rgb[1]) / spread / 6;
        if (hsv[0] < 0)
            hsv[0] += 1;
    }
}

static void hsv_to_rgb(double rgb[3], const double hsv[3])
{
    for (int c = 0; c < 3; c++) {
        /* A trapezium over the hue circle around red, green, blue. */
        double away = fabs(hsv[0] - c / 3.0);
        away = fmin(away, fabs(1 - away));
        const double full = 2 - 6 * away;
        rgb[c] = hsv[2] * (1 - hsv[1] * (1 - fmax(0, fmin(1, full))));
    }
}

static void lab_to_msh(double msh[3], const double lab[3])
{
    msh[0] = sqrt(lab[0] * lab[0] + lab[1] * lab[1] + lab[2] * lab[2]);
    msh[1] = msh[0] > 0.001 ? acos(fmax(-1, fmin(1, lab[0] / msh[0]))) : 0;
    msh[2] = msh[1] > 0.001 ? atan2(lab[2], lab[1]) : 0;
}

static void msh_to_lab(double lab[3], const double msh[3])
{
    lab[0] = msh[0] * cos(msh[1]);
    lab[1] = msh[0] * sin(msh[1]) * cos(msh[2]);
    lab[2] = msh[0] * sin(msh[1]) * sin(msh[2]);
}

/* Moreland 2009, section 5.1: the hue that an unsaturated colour of magnitude m takes beside a saturated one. */
static double adjusted_hue(const double msh[3], double m)
{
    if (msh[0] >= m - 0.1)
        return msh[2];
    const double spin = msh[1] * sqrt(m * m - msh[0] * msh[0]) / (msh[0] * sin(msh[1]));
    return msh[2] > -0.3 * pi ? msh[2] + spin : msh[2] - spin;
}

/* ----------------------------------------------------------------------------------------------- interpolation */

/* Weights of both ends for t, curve already chosen: sum is not 1 for a sharp curve, which adds slopes. */
typedef struct way {
    double t;      /* straight: position */
    double h1, h2; /* values' weights */
    double h3;     /* weight of the difference (both end slopes) */
    bool straight;
} way;

static double bend_midpoint(double t, double midpoint)
{
    midpoint = fmax(0.00001, fmin(0.99999, midpoint));
    return t < midpoint ? 0.5 * t / midpoint : 0.5 + 0.5 * (t - midpoint) / (1 - midpoint);
}

static way way_of(double t, double sharpness)
{
    way w = {.t = t, .straight = sharpness < 0.01};
    if (w.straight) {
        w.h1 = 1 - t;
        w.h2 = t;
        return w;
    }
    if (t < 0.5)
        t = 0.5 * pow(2 * t, 1 + 10 * sharpness);
    else if (t > 0.5)
        t = 1 - 0.5 * pow(2 * (1 - t), 1 + 10 * sharpness);
    const double t2 = t * t, t3 = t2 * t;
    w.h1 = 2 * t3 - 3 * t2 + 1;
    w.h2 = -2 * t3 + 3 * t2;
    w.h3 = (1 - sharpness) * ((t3 - 2 * t2 + t) + (t3 - t2));
    w.t = t;
    return w;
}

static double along(const way *w, double a, double b)
{
    return w->h1 * a + w->h2 * b + w->h3 * (b - a);
}

double tc_curve_interpolate(double a, double b, double t, double midpoint, double sharpness)
{
    t = bend_midpoint(t, midpoint);
    if (sharpness > 0.99)
        return t < 0.5 ? a : b;
    const way w = way_of(t, sharpness);
    return fmax(fmin(a, b), fmin(fmax(a, b), along(&w, a, b)));
}

static void interpolate_hsv(double out[3], const double a[3], const double b[3], const way *w, bool wrap)
{
    double from[3], to[3], hsv[3];
    rgb_to_hsv(from, a);
    rgb_to_hsv(to, b);
    if (wrap && fabs(from[0] - to[0]) > 0.5) {
        if (from[0] > to[0])
            from[0] -= 1;
        else
            to[0] -= 1;
    }
    for (int i = 0; i < 3; i++)
        hsv[i] = along(w, from[i], to[i]);
    if (hsv[0] < 0)
        hsv[0] += 1;
    for (int i = 1; i < 3; i++)
        hsv[i] = fmax(0, fmin(1, hsv[i]));
    hsv_to_rgb(out, hsv);
}

static void interpolate_lab(double out[3], const double a[3], const double b[3], const way *w)
{
    double from[3], to[3], lab[3];
    tc_color_rgb_to_lab(from, a);
    tc_color_rgb_to_lab(to, b);
    for (int i = 0; i < 3; i++)
        lab[i] = along(w, from[i], to[i]);
    tc_color_lab_to_rgb(out, lab);
}

/* Two saturated colours of clearly different hue have white put between them. */
static void interpolate_diverging(double out[3], const double a[3], const double b[3], double t)
{
    double lab[3], from[3], to[3], msh[3];
    tc_color_rgb_to_lab(lab, a);
    lab_to_msh(from, lab);
    tc_color_rgb_to_lab(lab, b);
    lab_to_msh(to, lab);
    double angle = fabs(from[2] - to[2]);
    angle = angle > pi ? 2 * pi - angle : angle;
    if (from[1] > 0.05 && to[1] > 0.05 && angle > 0.33 * pi) {
        const double middle = fmax(88, fmax(from[0], to[0]));
        double *replaced = t < 0.5 ? to : from;
        replaced[0] = middle;
        replaced[1] = replaced[2] = 0;
        t = t < 0.5 ? 2 * t : 2 * t - 1;
    }
    if (from[1] < 0.05 && to[1] > 0.05)
        from[2] = adjusted_hue(to, from[0]);
    else if (to[1] < 0.05 && from[1] > 0.05)
        to[2] = adjusted_hue(from, to[0]);
    for (int i = 0; i < 3; i++)
        msh[i] = (1 - t) * from[i] + t * to[i];
    msh_to_lab(lab, msh);
    tc_color_lab_to_rgb(out, lab);
}

void tc_color_interpolate(double out[3], tc_color_space space, bool hsv_wrap, const double a[3], const double b[3],
                          double t, double midpoint, double sharpness)
{
    t = bend_midpoint(t, midpoint);
    if (sharpness > 0.99) {
        for (int c = 0; c < 3; c++)
            out[c] = t < 0.5 ? a[c] : b[c];
        return;
    }
    const way w = way_of(t, sharpness);
    switch (space) {
    case TC_SPACE_HSV:
        interpolate_hsv(out, a, b, &w, hsv_wrap);
        break;
    case TC_SPACE_LAB:
        interpolate_lab(out, a, b, &w);
        break;
    case TC_SPACE_DIVERGING:
        interpolate_diverging(out, a, b, w.t);
        break;
    case TC_SPACE_STEP:
        for (int c = 0; c < 3; c++)
            out[c] = b[c];
        break;
    default:
        for (int c = 0; c < 3; c++)
            out[c] = along(&w, a[c], b[c]);
        break;
    }
    for (int c = 0; c < 3; c++)
        out[c] = fmax(0, fmin(1, out[c]));
}
