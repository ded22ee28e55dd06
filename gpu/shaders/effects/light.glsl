// light.glsl: what lights make of a colour (tc_shade; Blinn 1977): c becomes c gain + glow. Along a ray the directions to the
// eye and to the lights stay, and with them all that depends on no normal.

//@section march_declare
#ifdef LIGHT_GREY // all lights are: one channel stands for three
#define LIGHT float
#else
#define LIGHT vec3
#endif
uniform LIGHT light_ambient;
uniform LIGHT light_diffuse[LIGHTS]; // coefficient times the light's colour
#ifndef LIGHT_MATT
uniform LIGHT light_specular[LIGHTS];
uniform float light_power;
#endif
#ifndef LIGHT_HEAD // one light, from the eye
uniform vec4 light_to[LIGHTS]; // unit direction to it; w > 0: from the eye instead
#endif

struct Light {
    LIGHT gain, glow;
};
const Light LIGHT_NONE = Light(LIGHT(1.0), LIGHT(0.0)); // the colour as it is

LIGHT light_kept_ambient = LIGHT(0.0), light_kept_diffuse[LIGHTS];
#ifndef LIGHT_MATT
LIGHT light_kept_specular[LIGHTS];
float light_kept_power = 0.0;
#endif
#ifndef LIGHT_HEAD
vec3 light_toward[LIGHTS], light_between[LIGHTS]; // to the light; half way between it and the eye (0: they are opposite)
#endif

// Before the first light of a ray.
void light_begin(Ray ray)
{
    light_kept_ambient = keep(light_ambient);
#ifndef LIGHT_MATT
    light_kept_power = keep(light_power);
#endif
    for (int i = 0; i < LIGHTS; i++) {
        light_kept_diffuse[i] = keep(light_diffuse[i]);
#ifndef LIGHT_MATT
        light_kept_specular[i] = keep(light_specular[i]);
#endif
#ifndef LIGHT_HEAD
        vec4 to = light_to[i];
        light_toward[i] = to.w > 0.0 ? -ray.d : to.xyz;
        vec3 between = light_toward[i] - ray.d;
        float size = dot(between, between);
        light_between[i] = size > 1.0e-12 ? between * inversesqrt(size) : vec3(0.0);
#endif
    }
}

// For a unit normal n; `one_sided`: it is not turned towards the eye.
Light light_of(vec3 n, Ray ray, bool one_sided)
{
    Light light = Light(light_kept_ambient, LIGHT(0.0));
    float facing = -dot(n, ray.d);
#ifdef LIGHT_HEAD
    facing = one_sided ? max(facing, 0.0) : abs(facing);
    light.gain += light_kept_diffuse[0] * facing;
#ifndef LIGHT_MATT
    light.glow = facing > 0.0 ? light_kept_specular[0] * pow(facing, light_kept_power) : LIGHT(0.0);
#endif
#else
    n = !one_sided && facing < 0.0 ? -n : n;
    for (int i = 0; i < LIGHTS; i++) {
        float toward = dot(n, light_toward[i]);
        light.gain += light_kept_diffuse[i] * max(toward, 0.0);
#ifndef LIGHT_MATT
        float between = toward > 0.0 ? dot(n, light_between[i]) : 0.0;
        light.glow += between > 0.0 ? light_kept_specular[i] * pow(between, light_kept_power) : LIGHT(0.0);
#endif
    }
#endif
    return light;
}

//@section march_begin
    light_begin(ray);
