/* builtin.c: the built-in colour maps, named as in ParaView.
 *
 * Sources. Cool to Warm: K. Moreland 2009 (two colours through the Msh space; here with its white centre). Black-Body
 * Radiation, Grayscale, X Ray, Rainbow Desaturated, Jet: the few colours that define them in ParaView. Viridis,
 * Inferno, Plasma, Magma (N. Smith, S. van der Walt, E. Firing; CC0) and Cividis (J. Nunez, C. Anderton, R. Renslow
 * 2018; CC0): straight lines through a few of matplotlib's published colours, nowhere further than 2/255 from them.
 * Turbo (A. Mikhailov 2019, Apache-2.0): the same of its published colours. Places are in 1/255, colours in 1/10000. */
#include "transfer_functions/builtin.h"

#include <string.h>

static const short viridis[][4] = {{0, 2670, 49, 3294},     {21, 2832, 1208, 4406},  {40, 2706, 2141, 5071},
                                   {62, 2336, 3138, 5439},  {104, 1607, 4785, 5581}, {137, 1201, 6001, 5425},
                                   {151, 1301, 6514, 5216}, {164, 1757, 6979, 4910}, {179, 2669, 7488, 4406},
                                   {198, 4219, 8058, 3519}, {223, 6681, 8620, 1963}, {237, 8146, 8834, 1103},
                                   {244, 8863, 8924, 954},  {251, 9553, 9011, 1181}, {255, 9932, 9062, 1439}};
static const short inferno[][4] = {
    {0, 15, 5, 139},         {7, 117, 94, 635},       {19, 564, 346, 1684},    {32, 1293, 473, 2908},
    {42, 1973, 384, 3675},   {53, 2713, 409, 4120},   {70, 3790, 763, 4327},   {92, 5160, 1260, 4209},
    {115, 6585, 1790, 3727}, {140, 8019, 2587, 2831}, {162, 9020, 3645, 1841}, {183, 9634, 4955, 791},
    {194, 9808, 5722, 285},  {201, 9865, 6231, 278},  {209, 9877, 6828, 725},  {222, 9775, 7823, 1859},
    {233, 9587, 8666, 3108}, {243, 9464, 9372, 4586}, {251, 9662, 9807, 5872}, {255, 9884, 9984, 6449}};
static const short plasma[][4] = {{0, 504, 298, 5280},     {7, 1239, 229, 5594},    {26, 2612, 133, 6179},
                                  {49, 4055, 7, 6570},     {65, 5007, 141, 6571},   {80, 5844, 686, 6328},
                                  {107, 7149, 1873, 5463}, {143, 8501, 3470, 4172}, {178, 9471, 5127, 2990},
                                  {205, 9891, 6580, 2081}, {227, 9912, 7905, 1494}, {241, 9725, 8812, 1449},
                                  {252, 9466, 9552, 1503}, {255, 9400, 9752, 1313}};
static const short magma[][4] = {
    {0, 15, 5, 139},         {8, 137, 118, 687},      {23, 698, 497, 1937},    {38, 1468, 687, 3340},
    {49, 2185, 612, 4254},   {59, 2850, 632, 4725},   {76, 3904, 1004, 5019},  {104, 5629, 1654, 5047},
    {129, 7228, 2172, 4733}, {151, 8578, 2799, 4155}, {166, 9298, 3527, 3727}, {179, 9677, 4397, 3598},
    {193, 9876, 5430, 3852}, {211, 9968, 6755, 4613}, {235, 9942, 8485, 6057}, {255, 9871, 9914, 7495}};
static const short cividis[][4] = {{0, 0, 1262, 3015},      {20, 0, 1817, 4347},      {30, 0, 2073, 4329},
                                   {31, 55, 2101, 4322},    {35, 710, 2215, 4293},    {42, 1359, 2414, 4251},
                                   {57, 2232, 2836, 4203},  {89, 3546, 3734, 4294},   {134, 5121, 5035, 4734},
                                   {170, 6529, 6153, 4600}, {204, 7942, 7288, 4129},  {231, 9127, 8256, 3442},
                                   {249, 9954, 8940, 2708}, {252, 10000, 9057, 2593}, {255, 10000, 9169, 2731}};
static const short turbo[][4] = {
    {0, 1900, 718, 2322},    {8, 2250, 1635, 4510},   {16, 2511, 2524, 6337},  {24, 2682, 3382, 7805},
    {32, 2763, 4212, 8912},  {40, 2754, 5011, 9659},  {46, 2659, 5598, 9958},  {52, 2387, 6193, 9949},
    {60, 1862, 6977, 9550},  {71, 1164, 7974, 8556},  {79, 929, 8588, 7724},   {85, 1034, 8960, 7150},
    {92, 1532, 9315, 6431},  {100, 2480, 9642, 5430}, {114, 4585, 9966, 3614}, {123, 5865, 9974, 2685},
    {131, 6746, 9825, 2196}, {140, 7661, 9463, 2031}, {155, 8987, 8509, 2204}, {166, 9651, 7635, 2275},
    {177, 9944, 6639, 1997}, {189, 9899, 5285, 1440}, {203, 9454, 3664, 746},  {215, 8807, 2533, 352},
    {229, 7738, 1503, 115},  {243, 6308, 687, 40},    {255, 4796, 158, 106}};

/* Places in 1/1000000 of the map, colours alike. */
static const int cool_to_warm[][4] = {
    {0, 231373, 298039, 752941}, {500000, 865000, 865000, 865000}, {1000000, 705882, 15686, 149020}};
static const int black_body[][4] = {
    {0, 0, 0, 0}, {400000, 901961, 0, 0}, {800000, 901961, 901961, 0}, {1000000, 1000000, 1000000, 1000000}};
static const int grayscale[][4] = {{0, 0, 0, 0}, {1000000, 1000000, 1000000, 1000000}};
static const int x_ray[][4] = {{0, 1000000, 1000000, 1000000}, {1000000, 0, 0, 0}};
static const int rainbow_desaturated[][4] = {{0, 278431, 278431, 858824},   {143000, 0, 0, 360784},
                                             {285000, 0, 1000000, 1000000}, {429000, 0, 501961, 0},
                                             {571000, 1000000, 1000000, 0}, {714000, 1000000, 380392, 0},
                                             {857000, 419608, 0, 0},        {1000000, 878431, 301961, 301961}};
static const int jet[][4] = {{0, 0, 0, 562500},
                             {111111, 0, 0, 1000000},
                             {365080, 0, 1000000, 1000000},
                             {492064, 500000, 1000000, 500000},
                             {619048, 1000000, 1000000, 0},
                             {873016, 1000000, 0, 0},
                             {1000000, 500000, 0, 0}};

static const char *const names[] = {"Cool to Warm",
                                    "Viridis",
                                    "Inferno",
                                    "Plasma",
                                    "Magma",
                                    "Cividis",
                                    "Turbo",
                                    "Black-Body Radiation",
                                    "Grayscale",
                                    "X Ray",
                                    "Rainbow Desaturated",
                                    "Jet"};

#define COUNT(a) (sizeof(a) / sizeof *(a))

const char *const *tc_transfer_builtin(size_t *n)
{
    if (n)
        *n = COUNT(names);
    return names;
}

tc_preset *tc_builtin_preset(size_t index)
{
    static const struct {
        const short (*row)[4];
        const int (*point)[4];
        size_t n;
        tc_color_space space;
        double nan_color[3];
    } map[COUNT(names)] = {{NULL, cool_to_warm, COUNT(cool_to_warm), TC_SPACE_DIVERGING, {1, 1, 0}},
                           {viridis, NULL, COUNT(viridis), TC_SPACE_RGB, {1, 0, 0}},
                           {inferno, NULL, COUNT(inferno), TC_SPACE_RGB, {0, 1, 0}},
                           {plasma, NULL, COUNT(plasma), TC_SPACE_RGB, {0, 1, 0}},
                           {magma, NULL, COUNT(magma), TC_SPACE_RGB, {0, 1, 0}},
                           {cividis, NULL, COUNT(cividis), TC_SPACE_RGB, {1, 0, 0}},
                           {turbo, NULL, COUNT(turbo), TC_SPACE_RGB, {0, 0, 0}},
                           {NULL, black_body, COUNT(black_body), TC_SPACE_RGB, {0, 0.498039, 1}},
                           {NULL, grayscale, COUNT(grayscale), TC_SPACE_RGB, {1, 0, 0}},
                           {NULL, x_ray, COUNT(x_ray), TC_SPACE_RGB, {1, 0, 0}},
                           {NULL, rainbow_desaturated, COUNT(rainbow_desaturated), TC_SPACE_RGB, {1, 1, 0}},
                           {NULL, jet, COUNT(jet), TC_SPACE_RGB, {0.5, 0.5, 0.5}}};
    if (index >= COUNT(names))
        return NULL;
    tc_preset *preset = tc_preset_create(names[index], map[index].n, 0);
    if (!preset)
        return NULL;
    preset->space = map[index].space;
    preset->has_nan_color = true;
    memcpy(preset->nan_color, map[index].nan_color, sizeof preset->nan_color);
    for (size_t i = 0; i < map[index].n; i++) {
        const short *row = map[index].row ? map[index].row[i] : NULL;
        const int *point = map[index].point ? map[index].point[i] : NULL;
        preset->color[i].x = row ? row[0] / 255.0 : point[0] / 1e6;
        for (int c = 0; c < 3; c++)
            preset->color[i].rgb[c] = row ? row[1 + c] / 1e4 : point[1 + c] / 1e6;
    }
    return preset;
}
