/* test_reference_look_shade.c: gradients and light of the reference caster, against the formulas written down again
 * here, fields whose gradients are known, and planes fitted by elimination. */
#include "reference_look.h"

#include "reference/look.h"

static tc_knot grey_knot = {0, 1, 0.5, 0.25, 1.5};
static const double GREY[3] = {1, 0.5, 0.25};
static struct tc_transfer grey = {.n = 1, .knot = &grey_knot};
static tc_knot wild_knot[6] = {{0, 1, 0, 0, 0},   {0.3, 0, 1, 0, 6},   {0.3, 0, 0, 1, 1},
                               {0.5, 1, 1, 0, 0}, {0.52, 0, 1, 1, 40}, {0.9, 1, 0, 1, 2}};
static struct tc_transfer wild = {.n = 6, .knot = wild_knot};

static const tc_shade SOFT = {
    .volume = true, .surfaces = true, .ambient = 0.2, .diffuse = 0.8, .specular = 0.2, .power = 20, .magnitude = 1};

/* A lit colour for a normal, and a direction d of the ray: c' = gain c + glow. */
static void light(double gain[3], double glow[3], const tc_shade *shade, const double normal[3], const double d[3],
                  bool one_sided)
{
    double n[3];
    tc_vec_copy(n, normal);
    tc_vec_normalize(n);
    if (!one_sided && tc_vec_dot(n, d) > 0)
        for (int i = 0; i < 3; i++)
            n[i] *= -1;
    for (int c = 0; c < 3; c++)
        gain[c] = shade->ambient, glow[c] = 0;
    for (int k = 0; k < (shade->n_light ? shade->n_light : 1); k++) {
        double to[3] = {-d[0], -d[1], -d[2]}, color[3] = {1, 1, 1}, half[3];
        if (shade->n_light && !shade->light[k].head)
            tc_vec_copy(to, shade->light[k].direction);
        if (shade->n_light)
            tc_vec_copy(color, shade->light[k].color);
        tc_vec_normalize(to);
        tc_vec_sub(half, to, d);
        tc_vec_normalize(half);
        double facing = tc_vec_dot(n, to), shine = fmax(tc_vec_dot(n, half), 0);
        for (int c = 0; c < 3 && facing > 0; c++) {
            gain[c] += shade->diffuse * color[c] * facing;
            glow[c] += shade->specular * color[c] * pow(shine, shade->power);
        }
    }
}

/* Some shades of all kinds; lights [2]. */
static tc_shade some_shade(tc_light *lights, uint64_t *seed)
{
    tc_shade s = {.volume = true, .surfaces = true};
    s.ambient = uniform(seed, 0, 0.5), s.diffuse = uniform(seed, 0, 1), s.specular = uniform(seed, 0, 1);
    s.power = uniform(seed, 0.5, 30), s.magnitude = uniform(seed, 0, 2);
    s.one_sided = random_bits(seed) % 2;
    s.n_light = (int)(random_bits(seed) % 3);
    s.light = lights;
    for (int k = 0; k < 2; k++) {
        lights[k].head = random_bits(seed) % 4 == 0;
        for (int i = 0; i < 3; i++) {
            lights[k].direction[i] = uniform(seed, -3, 3);
            lights[k].color[i] = uniform(seed, 0, 1);
        }
    }
    return s;
}

/* ------------------------------------------------------------------------------------------------------ the formula */

/* A linear field has one gradient, so light does the same to all of the ray: to a volume of any function by m, to an
 * isosurface wholly. */
static void light_on_a_linear_field_is_not_that_of_its_gradient(void **state)
{
    (void)state;
    const double g[3] = {-0.3, -0.25, 0.4}, n[3] = {0.3, 0.25, -0.4}, steep = tc_vec_length(g), range = 0.95;
    struct tc_mesh m = kuhn_cube(3);
    linear_field(&m, 0.57, g[0], g[1], g[2]);
    tc_reference *plain = reference_of(&m), *r = reference_of(&m);
    uint64_t seed = 1;
    int surfaces = 0;
    for (int run = 0; run < 1500; run++) {
        tc_light lights[2];
        tc_look look = {.shade = some_shade(lights, &seed)};
        const tc_iso iso = {uniform(&seed, 0.2, 0.8), 0.7, true, {0.9, 0.4, 0.1}};
        double d[3], t[2], gain[3], glow[3];
        random_ray(d, t, &seed);
        look.shade.gradient = run % 2 ? TC_GRADIENT_VERTEX : TC_GRADIENT_CELL;
        if (run % 3 == 0)
            look.model = TC_MODEL_SURFACES, look.n_iso = 1, look.iso = &iso;
        light(gain, glow, &look.shade, n, d, look.shade.one_sided);
        look_of(r, &look);
        tc_reference_ray y = trace(r, &wild, OUTSIDE, d, 0);
        if (run % 3 == 0) {
            if (y.rgba[3] > 0)
                for (int c = 0; c < 3; c++)
                    NEAR(y.rgba[c], 0.7 * (gain[c] * iso.color[c] + glow[c]), 1e-12);
            surfaces += y.rgba[3] > 0;
            continue;
        }
        tc_reference_ray x = trace(plain, &wild, OUTSIDE, d, 0);
        double weight = steep / (steep + look.shade.magnitude * range / sqrt(3));
        for (int c = 0; c < 3; c++) /* the integral of c' da */
            NEAR(y.rgba[c], (1 - weight + weight * gain[c]) * x.rgba[c] + weight * glow[c] * x.rgba[3], 1e-12);
        NEAR(y.rgba[3], x.rgba[3], 1e-13);
    }
    assert_true(surfaces > 100);
    tc_reference_destroy(&plain);
    tc_reference_destroy(&r);
    mesh_free(&m);
}

/* By hand, so that the formula above is not just repeated: the ray looks along -z on a surface that faces it. */
static void simple_lights_give_other_numbers(void **state)
{
    (void)state;
    struct tc_mesh m = kuhn_cube(2);
    linear_field(&m, 1, 0, 0, -1); /* n = +z */
    const tc_iso iso = {0.5, 1, true, {0.5, 0.25, 1}};
    const double down[3] = {0, 0, -1}, up[3] = {0, 0, 1}, above[3] = {0.3, 0.4, 3}, below[3] = {0.3, 0.4, -3};
    tc_light side = {.direction = {0, 3, 3}, .color = {1, 1, 0.5}},
             behind = {.direction = {0, 0, -2}, .color = {1, 1, 1}};
    tc_shade plain = SOFT, one = SOFT, aside = SOFT, back = SOFT, none = SOFT, off = SOFT;
    plain.gradient = one.gradient = aside.gradient = back.gradient = off.gradient = TC_GRADIENT_CELL;
    one.one_sided = true;
    off.surfaces = false;
    aside.n_light = back.n_light = 1, aside.light = &side, back.light = &behind;
    aside.power = 2;
    /* H lies at 22.5 degrees: cos^2 = (1 + sqrt(1/2)) / 2 */
    const double c45 = sqrt(0.5), glow = 0.2 * (1 + c45) / 2;
    const struct {
        const tc_shade *shade;
        bool from_below;
        double rgb[3];
    } row[] = {{&plain, false, {0.7, 0.45, 1.2}},
               {&plain, true, {0.7, 0.45, 1.2}},
               {&one, true, {0.1, 0.05, 0.2}},
               {&aside, false, {0.1 + 0.4 * c45 + glow, 0.05 + 0.2 * c45 + glow, 0.2 + 0.4 * c45 + glow / 2}},
               {&back, false, {0.1, 0.05, 0.2}},
               {&none, false, {0.5, 0.25, 1}},
               {&off, false, {0.5, 0.25, 1}}};
    tc_reference *r = reference_of(&m);
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        const tc_look look = {.model = TC_MODEL_SURFACES, .n_iso = 1, .iso = &iso, .shade = *row[k].shade};
        look_of(r, &look);
        tc_reference_ray ray = trace(r, &grey, row[k].from_below ? below : above, row[k].from_below ? up : down, 0);
        for (int c = 0; c < 3; c++)
            NEAR(ray.rgba[c], row[k].rgb[c], 1e-13);
    }
    tc_reference_destroy(&r);
    mesh_free(&m);
}

static void flat_region_or_unlit_volume_changes_its_colour(void **state)
{
    (void)state;
    struct tc_mesh m = kuhn_cube(3);
    tc_reference *r = reference_of(&m);
    uint64_t seed = 2;
    for (int run = 0; run < 100; run++) {
        tc_light lights[2];
        tc_look look = {.shade = some_shade(lights, &seed)};
        double d[3], t[2];
        bool hit = random_ray(d, t, &seed);
        look.shade.gradient = run % 4 < 2 ? TC_GRADIENT_VERTEX : TC_GRADIENT_CELL;
        look.shade.volume = run % 2 == 0;
        linear_field(&m, 0.7, run % 2, 0.2 * (run % 2), 0); /* no gradient, or nothing lit */
        look_of(r, &look);
        tc_reference_ray ray = trace(r, &grey, OUTSIDE, d, 0);
        for (int c = 0; c < 3; c++)
            NEAR(ray.rgba[c], hit ? -expm1(-1.5 * (t[1] - t[0])) * GREY[c] : 0, 1e-12);
    }
    tc_reference_destroy(&r);
    mesh_free(&m);
}

/* A mesh a thousand times as large, elsewhere, with values a million times as far apart: the same picture. */
static void size_of_mesh_or_values_changes_the_light(void **state)
{
    (void)state;
    struct tc_mesh m = kuhn_cube(3), q = kuhn_cube(3);
    uint64_t seed = 3;
    for (size_t i = 0; i < m.n_vertex; i++) {
        m.scalar[i] = uniform(&seed, 0, 1);
        q.scalar[i] = 1e6 * m.scalar[i] - 3e5;
        for (int a = 0; a < 3; a++)
            q.vertex[3 * i + (size_t)a] = 1000 * (m.vertex[3 * i + (size_t)a] + 7);
    }
    tc_knot far_knot[6];
    for (int i = 0; i < 6; i++)
        far_knot[i] = wild_knot[i], far_knot[i].s = 1e6 * wild_knot[i].s - 3e5, far_knot[i].a /= 1000;
    struct tc_transfer far = {.n = 6, .knot = far_knot};
    tc_reference *a = reference_of(&m), *b = reference_of(&q);
    for (int run = 0; run < 60; run++) {
        tc_light lights[2];
        tc_look look = {.shade = some_shade(lights, &seed)};
        double d[3], t[2], o[3];
        random_ray(d, t, &seed);
        for (int i = 0; i < 3; i++)
            o[i] = 1000 * (OUTSIDE[i] + 7);
        look.shade.gradient = run % 2 ? TC_GRADIENT_VERTEX : TC_GRADIENT_CELL;
        look_of(a, &look), look_of(b, &look);
        tc_reference_ray x = trace(a, &wild, OUTSIDE, d, 0), y = trace(b, &far, o, d, 0);
        for (int c = 0; c < 4; c++)
            NEAR(y.rgba[c], x.rgba[c], 1e-8);
    }
    tc_reference_destroy(&a);
    tc_reference_destroy(&b);
    mesh_free(&m);
    mesh_free(&q);
}

/* -------------------------------------------------------------------------------------------------------- vertices */

/* Largest error of n . L on a sphere of |x - middle|^2 on n^3 cubes. */
static double sphere_error(int n, tc_gradient gradient)
{
    struct tc_mesh m = kuhn_cube(n);
    for (size_t i = 0; i < m.n_vertex; i++) {
        const double *x = &m.vertex[3 * i];
        m.scalar[i] = -(x[0] - 0.5) * (x[0] - 0.5) - (x[1] - 0.5) * (x[1] - 0.5) - (x[2] - 0.5) * (x[2] - 0.5);
    }
    const double radius = 0.3;
    const tc_iso iso = {-radius * radius, 1, true, {1, 1, 1}};
    const tc_light sun = {.direction = {0.48, 0.6, 0.64}, .color = {1, 1, 1}};
    const tc_look look = {
        .model = TC_MODEL_SURFACES,
        .n_iso = 1,
        .iso = &iso,
        .shade = {.gradient = gradient, .surfaces = true, .diffuse = 1, .power = 1, .n_light = 1, .light = &sun}};
    tc_reference *r = reference_of(&m);
    look_of(r, &look);
    uint64_t seed = 4;
    double worst = 0;
    for (int run = 0; run < 2000; run++) {
        double x = uniform(&seed, -0.25, 0.25), y = uniform(&seed, -0.25, 0.25), h2 = radius * radius - x * x - y * y;
        if (h2 < 0.02)
            continue;
        const double o[3] = {0.5 + x, 0.5 + y, 3}, down[3] = {0, 0, -1}, normal[3] = {x, y, sqrt(h2)};
        tc_reference_ray ray = trace(r, &grey, o, down, 0);
        worst = fmax(worst, fabs(ray.rgba[0] - fmax(tc_vec_dot(normal, sun.direction) / radius, 0)));
    }
    tc_reference_destroy(&r);
    mesh_free(&m);
    return worst;
}

static void normals_of_vertices_do_not_become_those_of_a_sphere(void **state)
{
    (void)state;
    double smooth8 = sphere_error(8, TC_GRADIENT_VERTEX), smooth16 = sphere_error(16, TC_GRADIENT_VERTEX);
    double flat8 = sphere_error(8, TC_GRADIENT_CELL), flat16 = sphere_error(16, TC_GRADIENT_CELL);
    assert_true(smooth16 > 0 && smooth16 < 0.4 * smooth8); /* second order; flat: first */
    assert_true(flat16 > 0.3 * flat8 && flat16 < 0.75 * flat8);
    assert_true(smooth16 < 0.15 * flat16);
}

/* Gradients of all cells and vertices, per length of the mesh's; of the caller, free(). */
static double *gradients(const struct tc_mesh *m, bool of_vertices)
{
    tc_reference *r = reference_of(m);
    double *cell = malloc((3 * m->n_tet + 1) * sizeof *cell), *vertex = malloc((3 * m->n_vertex + 1) * sizeof *vertex);
    assert_true(cell && vertex);
    assert_int_equal(tc_gradient_of_cells(cell, r), TC_OK);
    assert_int_equal(tc_gradient_of_vertices(vertex, cell, r), TC_OK);
    for (size_t i = 0; i < 3 * m->n_tet; i++)
        cell[i] *= r->scale;
    for (size_t i = 0; i < 3 * m->n_vertex; i++)
        vertex[i] *= r->scale;
    tc_reference_destroy(&r);
    free(of_vertices ? cell : vertex);
    return of_vertices ? vertex : cell;
}

static void near_vector(const double *g, double x, double y, double z, double tolerance)
{
    NEAR(g[0], x, tolerance);
    NEAR(g[1], y, tolerance);
    NEAR(g[2], z, tolerance);
}

/* A tet of height 1 below the triangle 0 1 2, one of height 0.25 above it, and a flat one beside. */
static struct tc_mesh two_and_a_flat_one(void)
{
    const double x[18] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0.2, 0.2, -1, 0.2, 0.2, 0.25, 1, 1, 0};
    const int32_t tet[12] = {0, 1, 2, 3, 1, 0, 2, 4, 0, 1, 2, 5};
    struct tc_mesh m = mesh_alloc(6, 3);
    memcpy(m.vertex, x, sizeof x);
    memcpy(m.tet, tet, sizeof tet);
    return m;
}

static void gradient_at_a_vertex_is_no_mean_by_volume(void **state)
{
    (void)state;
    struct tc_mesh m = two_and_a_flat_one();
    for (int i = 0; i < 6; i++)
        m.scalar[i] = 2 * m.vertex[3 * i] + (i == 3 ? 1 : i == 4 ? 0.75 : 0); /* along z: -1 below, 3 above */
    m.scalar[5] = 400;                                                        /* of the flat one alone */
    double *cell = gradients(&m, false), *vertex = gradients(&m, true);
    near_vector(cell, 2, 0, -1, 1e-14);
    near_vector(cell + 3, 2, 0, 3, 1e-14);
    near_vector(cell + 6, 0, 0, 0, 0);
    for (int i = 0; i < 3; i++)
        near_vector(vertex + 3 * i, 2, 0, (-1 + 0.25 * 3) / 1.25, 1e-14);
    near_vector(vertex + 9, 2, 0, -1, 1e-14);
    near_vector(vertex + 12, 2, 0, 3, 1e-14);
    near_vector(vertex + 15, 0, 0, 0, 0);
    free(cell), free(vertex);
    mesh_free(&m);
}

/* Corners in the plane z = x + y, exactly, which rounding does not see: no gradient, and no weight in means. */
static void flat_cell_has_a_gradient_by_rounding(void **state)
{
    (void)state;
    enum { N = 200 };
    struct tc_mesh m = mesh_alloc(4 * N, N);
    uint64_t seed = 7;
    for (int i = 0; i < 4 * N; i++) {
        double *x = &m.vertex[3 * i];
        x[0] = ldexp(floor(uniform(&seed, -0x1p40, 0x1p40)), -40);
        x[1] = ldexp(floor(uniform(&seed, -0x1p40, 0x1p40)), -40);
        x[2] = x[0] + x[1];
        m.scalar[i] = uniform(&seed, 0, 1);
        m.tet[i] = i;
    }
    double *cell = gradients(&m, false);
    for (int t = 0; t < N; t++)
        near_vector(cell + 3 * t, 0, 0, 0, 0);
    free(cell);
    mesh_free(&m);
}

/* As thin as 2^-44, all that is given exact: a linear field's gradient is to be found to the fourth digit. */
static void thin_cell_has_a_gradient_by_rounding(void **state)
{
    (void)state;
    enum { N = 200 };
    struct tc_mesh m = mesh_alloc(4 * N, N);
    uint64_t seed = 8;
    for (int i = 0; i < 4 * N; i++) {
        double *x = &m.vertex[3 * i];
        x[0] = ldexp(floor(uniform(&seed, 0, 0x1p44)), -44) + (i % 4 == 1);
        x[1] = ldexp(floor(uniform(&seed, 0, 0x1p44)), -44) + (i % 4 == 2);
        x[2] = x[0] + x[1] + (i % 4 == 3 ? 0x1p-44 : 0);
        m.scalar[i] = 2 * x[0] - x[1] + 3 * x[2];
        m.tet[i] = i;
    }
    double *cell = gradients(&m, false);
    int thin = 0;
    for (int t = 0; t < N; t++) {
        const double *x = &m.vertex[12 * t];
        double area = (x[3] - x[0]) * (x[7] - x[1]) - (x[4] - x[1]) * (x[6] - x[0]);
        if (fabs(area) < 0.3)
            continue;
        near_vector(cell + 3 * t, 2, -1, 3, 1e-4);
        thin++;
    }
    assert_true(thin > N / 2);
    free(cell);
    mesh_free(&m);
}

/* A vertical ray through the lower tet, cut to z = -0.1 … -0.6: it is lit there, not where the cell ends. */
static void light_on_a_cell_is_not_the_mean_of_that_at_its_two_ends(void **state)
{
    (void)state;
    struct tc_mesh m = two_and_a_flat_one();
    for (int i = 0; i < 5; i++)
        m.scalar[i] = 2 * m.vertex[3 * i] + (i == 3 ? 1 : i == 4 ? 0.75 : 0);
    m.n_tet = 2;
    const tc_plane part[2] = {{{0, 0, 1}, -0.6}, {{0, 0, -1}, 0.1}};
    tc_look look = {.shade = SOFT, .n_plane = 2, .plane = part};
    look.shade.gradient = TC_GRADIENT_VERTEX;
    look.shade.one_sided = true;
    tc_reference *r = reference_of(&m);
    look_of(r, &look);
    const double o[3] = {0.21, 0.21, 3}, down[3] = {0, 0, -1}, alpha = -expm1(-1.5 * 0.5);
    const double range = 2 - 0, diagonal = sqrt(1 + 1 + 1.25 * 1.25); /* 0 … 2: the values at 0 and 1 */
    double factor[3] = {0, 0, 0}, extra[3] = {0, 0, 0};
    for (int k = 0; k < 2; k++) {
        double z = k ? -0.6 : -0.1, along_z = (1 + z) * (-1 + 0.25 * 3) / 1.25 + -z * -1, n[3] = {-2, 0, -along_z};
        double gain[3], glow[3], steep = tc_vec_length(n), weight = steep / (steep + range / diagonal);
        light(gain, glow, &look.shade, n, down, true);
        for (int c = 0; c < 3; c++) {
            factor[c] += 0.5 * (1 - weight + weight * gain[c]);
            extra[c] += 0.5 * weight * glow[c];
        }
    }
    tc_reference_ray ray = trace(r, &grey, o, down, 0);
    NEAR(ray.rgba[3], alpha, 1e-13);
    for (int c = 0; c < 3; c++)
        NEAR(ray.rgba[c], alpha * (factor[c] * GREY[c] + extra[c]), 1e-13);
    tc_reference_destroy(&r);
    mesh_free(&m);
}

static void unknown_value_spoils_gradients_around_it(void **state)
{
    (void)state;
    struct tc_mesh m = kuhn_cube(4);
    linear_field(&m, 0.3, 0.5, -2, 1);
    const size_t bad = 2 * 25 + 2 * 5 + 2; /* the middle */
    m.scalar[bad] = NAN;
    double *cell = gradients(&m, false), *vertex = gradients(&m, true);
    for (size_t t = 0; t < m.n_tet; t++) {
        bool has = false;
        for (int k = 0; k < 4; k++)
            has = has || m.tet[4 * t + (size_t)k] == (int32_t)bad;
        near_vector(cell + 3 * t, has ? 0 : 0.5, has ? 0 : -2, has ? 0 : 1, 1e-13);
    }
    for (size_t i = 0; i < m.n_vertex; i++)
        near_vector(vertex + 3 * i, i == bad ? 0 : 0.5, i == bad ? 0 : -2, i == bad ? 0 : 1, 1e-13);
    free(cell), free(vertex);
    /* Light does not fall on the cells that show the colour of missing values. */
    static const double nan_color[4] = {0.3, 0.2, 0.1, 1e3};
    tc_reference *r = reference_of(&m);
    tc_reference_set_nan_color(r, nan_color);
    const tc_look look = {.shade = {.gradient = TC_GRADIENT_VERTEX, .volume = true, .ambient = 7, .power = 1}};
    look_of(r, &look);
    const double down[3] = {0, 0, -1}, middle[3] = {0.52, 0.51, 0.6};
    tc_reference_ray ray = trace(r, &grey, middle, down, 0);
    for (int c = 0; c < 3; c++)
        NEAR(ray.rgba[c], nan_color[c], 1e-12);
    tc_reference_destroy(&r);
    mesh_free(&m);
}

/* ------------------------------------------------------------------------------------------------------- cell data */

static void centroid(double out[3], const struct tc_mesh *m, size_t tet)
{
    out[0] = out[1] = out[2] = 0;
    for (int k = 0; k < 4; k++)
        tc_vec_mul_add(out, out, 0.25, &m->vertex[3 * (size_t)m->tet[4 * tet + (size_t)k]]);
}

/* Neighbours by comparing all with all: three common vertices. */
static int neighbours(size_t out[4], const struct tc_mesh *m, size_t tet)
{
    int n = 0;
    for (size_t t = 0; t < m->n_tet; t++) {
        int common = 0;
        for (int i = 0; i < 16; i++)
            common += m->tet[4 * tet + (size_t)i / 4] == m->tet[4 * t + (size_t)i % 4];
        if (common == 3)
            out[n++] = t;
    }
    return n;
}

/* s = c0 + c . x that fits n points best: normal equations, elimination with pivots. */
static void fit(double c[4], double x[5][3], const double *s, int n)
{
    double a[4][5] = {{0}};
    for (int k = 0; k < n; k++) {
        const double row[5] = {1, x[k][0], x[k][1], x[k][2], s[k]};
        for (int i = 0; i < 4; i++)
            for (int j = 0; j < 5; j++)
                a[i][j] += row[i] * row[j];
    }
    for (int i = 0; i < 4; i++) {
        int p = i;
        for (int k = i + 1; k < 4; k++)
            p = fabs(a[k][i]) > fabs(a[p][i]) ? k : p;
        for (int j = 0; j < 5; j++) {
            double t = a[i][j];
            a[i][j] = a[p][j], a[p][j] = t;
        }
        for (int k = 0; k < 4; k++)
            for (int j = 4; k != i && j >= i; j--)
                a[k][j] -= a[k][i] / a[i][i] * a[i][j];
    }
    for (int i = 0; i < 4; i++)
        c[i] = a[i][4] / a[i][i];
}

static void gradient_of_cell_data_is_not_that_of_the_best_plane(void **state)
{
    (void)state;
    struct tc_mesh m = kuhn_cube(3);
    uint64_t seed = 5;
    for (size_t i = 0; i < m.n_vertex; i++)
        for (int a = 0; a < 3; a++)
            m.vertex[3 * i + (size_t)a] += uniform(&seed, -0.04, 0.04);
    free(m.scalar);
    m.scalar = malloc(m.n_tet * sizeof *m.scalar);
    assert_non_null(m.scalar);
    m.association = TC_CELL_DATA;
    for (int kind = 0; kind < 3; kind++) {
        for (size_t t = 0; t < m.n_tet; t++) {
            double x[3];
            centroid(x, &m, t);
            m.scalar[t] = kind ? uniform(&seed, 0, 1) : 0.2 + 0.5 * x[0] - x[1] + 3 * x[2];
            if (kind == 2 && t % 7 == 3)
                m.scalar[t] = t % 2 ? NAN : -INFINITY;
        }
        double *cell = gradients(&m, false);
        int full = 0;
        for (size_t t = 0; t < m.n_tet; t++) {
            size_t near[4];
            double x[5][3], s[5], c[4];
            int n_near = neighbours(near, &m, t), n = 0;
            for (int k = -1; k < n_near; k++) {
                size_t at = k < 0 ? t : near[k];
                if (isfinite(m.scalar[at]))
                    centroid(x[n], &m, at), s[n++] = m.scalar[at];
            }
            if (!isfinite(m.scalar[t]))
                near_vector(cell + 3 * t, 0, 0, 0, 0);
            if (!isfinite(m.scalar[t]) || n < 4)
                continue;
            fit(c, x, s, n);
            near_vector(cell + 3 * t, c[1], c[2], c[3], 1e-8 * (1 + tc_vec_length(c + 1)));
            if (kind == 0)
                near_vector(cell + 3 * t, 0.5, -1, 3, 1e-9);
            full++;
        }
        assert_true(full > 80);
        free(cell);
    }
    mesh_free(&m);
}

static void cells_without_enough_neighbours_have_any_gradient(void **state)
{
    (void)state;
    struct tc_mesh m = two_and_a_flat_one();
    m.association = TC_CELL_DATA;
    const double value[3] = {2, 5, 11};
    memcpy(m.scalar, value, sizeof value);
    m.n_tet = 1; /* alone */
    double *cell = gradients(&m, false);
    near_vector(cell, 0, 0, 0, 0);
    free(cell);
    m.n_tet = 2; /* two: along the line of their centroids, (0, 0, 1.25 / 4) apart */
    cell = gradients(&m, false);
    for (int k = 0; k < 2; k++)
        near_vector(cell + 3 * k, 0, 0, 3 * 4 / 1.25, 1e-13);
    free(cell);
    m.n_tet = 3; /* three at one face: no neighbours */
    cell = gradients(&m, false);
    for (int k = 0; k < 3; k++)
        near_vector(cell + 3 * k, 0, 0, 0, 0);
    free(cell);
    m.n_tet = 2; /* two on one side */
    m.vertex[3 * 4 + 2] = -0.5;
    cell = gradients(&m, false);
    for (int k = 0; k < 2; k++)
        near_vector(cell + 3 * k, 0, 0, 0, 0);
    free(cell);
    m.vertex[3 * 4 + 2] = 0.25; /* one is unknown: the other is alone */
    m.scalar[1] = NAN;
    cell = gradients(&m, false);
    for (int k = 0; k < 2; k++)
        near_vector(cell + 3 * k, 0, 0, 0, 0);
    free(cell);
    mesh_free(&m);
}

/* Cell data are lit cell by cell: behind each other with their own gradients. */
static void cell_data_are_not_lit_cell_by_cell(void **state)
{
    (void)state;
    struct tc_mesh m = two_and_a_flat_one();
    m.n_tet = 2;
    m.association = TC_CELL_DATA;
    m.scalar[0] = 0, m.scalar[1] = 1;
    tc_look look = {.shade = SOFT};
    look.shade.gradient = TC_GRADIENT_CELL;
    tc_reference *r = reference_of(&m), *plain = reference_of(&m);
    look_of(r, &look);
    const double d[3] = {0, 0.6, -0.8}, o[3] = {0.25, 0.2 - 0.6 * 2, 0.05 + 0.8 * 2}, n[3] = {0, 0, -1};
    const double steep = 4 / 1.25, weight = steep / (steep + 1 / sqrt(1 + 1 + 1.25 * 1.25));
    double gain[3], glow[3];
    light(gain, glow, &look.shade, n, d, false);
    tc_reference_ray x = trace(plain, &wild, o, d, 0), y = trace(r, &wild, o, d, 0);
    assert_int_equal(x.segments, 2);
    for (int c = 0; c < 3; c++)
        NEAR(y.rgba[c], (1 - weight + weight * gain[c]) * x.rgba[c] + weight * glow[c] * x.rgba[3], 1e-12);
    tc_reference_destroy(&r);
    tc_reference_destroy(&plain);
    mesh_free(&m);
}

/* ------------------------------------------------------------------------------------------------------- geometry */

static void light_on_geometry_is_not_that_of_its_own_normal(void **state)
{
    (void)state;
    struct tc_mesh m = kuhn_cube(1);
    linear_field(&m, 0, 1, 0, 0);
    tc_reference *r = reference_of(&m);
    uint64_t seed = 6;
    int met = 0;
    for (int run = 0; run < 1500; run++) {
        double x[9], a[3], b[3], n[3], d[3], t[2], gain[3], glow[3];
        for (int i = 0; i < 9; i++)
            x[i] = uniform(&seed, -0.5, 1.5);
        const int32_t id[3] = {run % 2 ? 2 : 0, 1, run % 2 ? 0 : 2};
        const tc_geometry geometry = {.n_vertex = 3,
                                      .n_triangle = 1,
                                      .vertex = x,
                                      .triangle = id,
                                      .color = {0.8, 0.3, 0.1},
                                      .opacity = 0.6,
                                      .lit = run % 3 != 0};
        tc_light lights[2];
        tc_look look = {
            .model = TC_MODEL_SURFACES, .n_geometry = 1, .geometry = &geometry, .shade = some_shade(lights, &seed)};
        look.shade.gradient = run % 7 ? TC_GRADIENT_CELL : TC_GRADIENT_NONE;
        random_ray(d, t, &seed);
        tc_vec_sub(a, x + 3, x), tc_vec_sub(b, x + 6, x);
        tc_vec_cross(n, a, b);
        light(gain, glow, &look.shade, n, d, false); /* always two-sided */
        look_of(r, &look);
        tc_reference_ray ray = trace(r, &grey, OUTSIDE, d, 0);
        bool lit = geometry.lit && run % 7;
        for (int c = 0; c < 3 && ray.rgba[3] > 0; c++)
            NEAR(ray.rgba[c], 0.6 * (lit ? gain[c] * geometry.color[c] + glow[c] : geometry.color[c]), 1e-12);
        met += ray.rgba[3] > 0 && lit;
    }
    assert_true(met > 30);
    tc_reference_destroy(&r);
    mesh_free(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(light_on_a_linear_field_is_not_that_of_its_gradient),
        cmocka_unit_test(simple_lights_give_other_numbers),
        cmocka_unit_test(flat_region_or_unlit_volume_changes_its_colour),
        cmocka_unit_test(size_of_mesh_or_values_changes_the_light),
        cmocka_unit_test(normals_of_vertices_do_not_become_those_of_a_sphere),
        cmocka_unit_test(gradient_at_a_vertex_is_no_mean_by_volume),
        cmocka_unit_test(flat_cell_has_a_gradient_by_rounding),
        cmocka_unit_test(thin_cell_has_a_gradient_by_rounding),
        cmocka_unit_test(light_on_a_cell_is_not_the_mean_of_that_at_its_two_ends),
        cmocka_unit_test(unknown_value_spoils_gradients_around_it),
        cmocka_unit_test(gradient_of_cell_data_is_not_that_of_the_best_plane),
        cmocka_unit_test(cells_without_enough_neighbours_have_any_gradient),
        cmocka_unit_test(cell_data_are_not_lit_cell_by_cell),
        cmocka_unit_test(light_on_geometry_is_not_that_of_its_own_normal),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
