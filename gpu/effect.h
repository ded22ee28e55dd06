/* effect.h: what a picture may call for beside the walk through cells, as rows of one table.
 *
 * A row says what turns it on and what it needs; what puts programs together, packs, uploads, binds and passes reads
 * the rows in force and knows none by name. How to add one: docs/adding_an_effect.md. */
#ifndef TC_GPU_EFFECT_H
#define TC_GPU_EFFECT_H

#include "gpu/job.h"

enum { TC_EFFECTS_MOST = 32, TC_EFFECT_WHY = 160, TC_ISO_MOST = 64 };

/* What needs of a row are. */
enum {
    TC_NEEDS_PIECES = 1, /* the function is integrated piece by piece: segments are added where and when they are met */
    TC_NEEDS_RANGE = 2,  /* rays begin and end anywhere: ray.near and ray.far are there */
    TC_NEEDS_STATE_32F = 4,    /* what rays carry are numbers, not colours */
    TC_NEEDS_POINTS = 8,       /* values of points: cell data will not do */
    TC_NEEDS_SIGNS = 16,       /* the stepper whose walk knows its face's vertices and weights */
    TC_NEEDS_NO_FUNCTION = 32, /* none is looked at: none is uploaded */
    TC_NEEDS_SUMS = 64,        /* what segments add can be told from what was there: any integrator but the table */
    TC_NEEDS_WAY =
        128, /* rays keep tc_state_set.at from one entry to the next: no first hit but the first empties it */
    TC_NEEDS_NUMBERS = 256, /* what a picture of colours may leave out counts: small changes of the function; what lies
                               behind where a ray is nearly opaque, so that rays end where shaders say */
};

/* Images of what effects fetch (fetch.glsl) where the renderer is software, which has few: a row of each line at a
 * time. Those of the paper's stepper are free, for it knows no effects that need them. On GPUs they are textures,
 * TC_UNIT_EFFECT_TEXTURE above. */
enum {
    TC_UNIT_EFFECT_MASK = 4,  /* bits of cells */
    TC_UNIT_EFFECT_SHADE = 5, /* gradients */
    TC_UNIT_EFFECT_COLOR = 6, /* a second field */
    TC_UNIT_EFFECT_PIECES = 7,
    TC_UNIT_EFFECT_EMPTY = 14,   /* bits of cells, too */
    TC_UNIT_EFFECT_TEXTURE = 16, /* on GPUs: what is image i elsewhere is texture TC_UNIT_EFFECT_TEXTURE + i */
    TC_UNIT_EFFECT_LAYERS = 16,  /* geometry: three textures everywhere */
};

/* What rows are asked about. */
typedef struct tc_effect_scene {
    const tc_mesh *mesh;
    const tc_transfer *transfer; /* the picture's own */
    const tc_render_options *options;
    const tc_look *look;                /* never NULL */
    double center[3], scale, scalar[2]; /* as tc_pack has them */
    double length_unit;                 /* as tc_job has it */
    int threads;
    void *memo; /* of the row that is asked whether it is wanted; NULL: nothing is kept */
    bool clear; /* the function shows none of the values, and nothing else is to be seen: no ray will be walked */
} tc_effect_scene;

typedef struct tc_effect {
    const char *name, *what;
    /* gpu/shaders/effects/…, in the order in which their sections are to stand; "": it changes the function alone. */
    const char *shaders;
    const char *integrator; /* stands for integrator.glsl; NULL */
    const char *excludes;   /* names of other rows, " a b "; NULL */
    unsigned needs;
    bool model; /* one of those of tc_model */
    /* Does the scene call for it? why [TC_EFFECT_WHY] gets the reason, also for not. */
    bool (*wanted)(char *why, const tc_effect_scene *scene);
    size_t memo_bytes; /* what wanted keeps in scene->memo from picture to picture, not to find it out for each; zeros
                          at first */
    /* Lines "#define …" that its shaders go by; NULL: none. Behind what is in out. */
    void (*define)(char *out, size_t capacity, const tc_effect_scene *scene);
    /* The function that stands for the picture's; NULL: itself. In place, knot by knot. */
    void (*knot)(tc_knot *knot, const tc_effect_scene *scene);
    /* May it leave cells without a value? Then these are as cells whose own is not finite. NULL: no. */
    bool (*nonfinite)(const tc_effect_scene *scene);
    /* Rounds of march.glsl's loop that a step may take besides; NULL: none. */
    int (*rounds)(const tc_effect_scene *scene);
    /* Packs and uploads what is not there yet. *bytes gets what it holds on the GPU. state: zeros at first, of
     * state_bytes. */
    size_t state_bytes;
    tc_status (*update)(void *state, size_t *bytes, const tc_effect_scene *scene, const tc_gl *gl, tc_error *err);
    void (*finish)(void *state, const tc_gl *gl);
    /* Makes what depends on the frame of rays (job->frame), before their first hits, within the scissor rectangle,
     * which is then the whole picture: rays that miss the mesh may see it, too. compile: the programs alone. Both or
     * neither. */
    tc_status (*compile)(void *state, const tc_effect_scene *scene, const tc_job *job, tc_error *err);
    tc_status (*frame)(void *state, const tc_effect_scene *scene, const tc_job *job, tc_error *err);
    /* Bytes on the GPU after that; NULL: those of update. */
    size_t (*held)(const void *state);
    /* Binds what its shaders read: the program of the march, or the one that makes colours of what rays gathered. */
    void (*bind)(const void *state, const tc_effect_scene *scene, const tc_job *job, GLuint program);
    /* The largest r, g, b with its own colours, where those of the others are up to most; NULL: no more. */
    void (*brighten)(double most[3], const tc_effect_scene *scene);
    bool lights; /* brighten is of light, on all other colours */
} tc_effect;

/* All rows, in the order in which their sections stand; NULL ends them. */
extern const tc_effect *const tc_effect_table[];

/* The rows in force for a picture, and what follows from them. */
typedef struct tc_effects {
    int n;
    const tc_effect *row[TC_EFFECTS_MOST];
    int place[TC_EFFECTS_MOST]; /* in tc_effect_table */
    char why[TC_EFFECTS_MOST][TC_EFFECT_WHY];
    char why_not[TC_EFFECTS_MOST][TC_EFFECT_WHY]; /* by place in the table, of those not in force */
    tc_effect_scene scene;
    unsigned needs;
    int rounds;
    bool nonfinite;
    char shaders[512], defines[512];
    const char *integrator;
    double bytes[TC_EFFECTS_MOST];
    const struct tc_effect_store *store;
} tc_effects;

/* What rows keep in a GL context from picture to picture. */
typedef struct tc_effect_store {
    void *state[TC_EFFECTS_MOST];  /* by place in the table; NULL: nothing */
    double bytes[TC_EFFECTS_MOST]; /* that these hold on the GPU */
    void *memo[TC_EFFECTS_MOST];   /* of wanted */
    tc_transfer *function;         /* that stands for the picture's */
    uint64_t function_serial;      /* of the one that it was made of, */
    int function_place;            /* … by this row */
} tc_effect_store;

/* Which rows are in force. store keeps what they found out; NULL: nothing does. Errors: TC_E_ARG (two exclude each
 * other, data or stepper will not do; names both). */
tc_status tc_effects_choose(tc_effects *out, tc_effect_store *store, const tc_effect_scene *scene, tc_error *err);
/* The function that the picture is made with: the scene's own, or one that a row makes of it, which store keeps.
 * Errors: TC_E_MEMORY. */
tc_status tc_effects_function(const tc_transfer **out, tc_effect_store *store, const tc_effects *effects,
                              tc_error *err);
/* Uploads what rows in force need, frees what others left. Errors: theirs. */
tc_status tc_effects_update(tc_effects *effects, tc_effect_store *store, const tc_gl *gl, tc_error *err);
/* Are colours those of the function along the walk alone? */
bool tc_effects_are_plain(const tc_effects *effects);
/* What rows make for each frame of rays; whether any does. Errors: as theirs. */
bool tc_effects_have_frame(const tc_effects *effects);
tc_status tc_effects_compile(const tc_effects *effects, const tc_job *job, tc_error *err);
tc_status tc_effects_frame(const tc_effects *effects, const tc_job *job, tc_error *err);
/* What rows hold on the GPU by now; sets effects->bytes. */
double tc_effects_bytes(tc_effects *effects);
/* Binds what shaders declare with FETCH_…(unit): to that image, or to the texture TC_UNIT_EFFECT_TEXTURE + unit. */
void tc_effect_fetch(const tc_job *job, GLuint program, const char *name, GLuint unit, GLenum format, GLuint texture);
/* Of the program in use. */
void tc_effects_bind(const tc_effects *effects, const tc_job *job, GLuint program);
/* What a row makes of the function's colours holds for that of missing values: r, g, b, attenuation, in place. */
void tc_effects_nan_color(double color[4], const tc_effects *effects);
void tc_effects_brighten(double most[3], const tc_effects *effects);
/* Their names, with ", " between them. */
void tc_effects_names(char *out, size_t capacity, const tc_effects *effects);
void tc_effect_store_finish(tc_effect_store *store, const tc_gl *gl);

#endif
