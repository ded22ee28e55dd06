// copy.frag: the finished picture, premultiplied, into the host's framebuffer.
uniform sampler2D picture;
layout(location = 0) out vec4 out_rgba;
void main()
{
    out_rgba = texelFetch(picture, ivec2(gl_FragCoord.xy), 0);
}
