// integrate_at_once.glsl: what the integrators share that add a segment at once, stop at nothing and do not show cells without a
// value. Included behind their struct Integral.

// No round need follow.
bool integral_round(inout Integral i)
{
    return false;
}

bool integral_waits(Integral i)
{
    return false;
}

void integral_stop(inout Integral i, float s)
{
}

#ifdef NAN_COLOR
void integral_add_constant(inout Integral i, vec4 color, float l)
{
}
#endif
