/* view_draw.c: draws a picture's layers. */
#include "window/view_draw.h"

#include <epoxy/gl.h>
#include <stdio.h>

static const char vertex_text[] = "#version 330\n"
                                  "uniform float stretch;\n"
                                  "out vec2 at;\n"
                                  "void main()\n"
                                  "{\n"
                                  "    vec2 p = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);\n"
                                  "    at = vec2(p.x / stretch, p.y) * 0.5 + 0.5;\n"
                                  "    gl_Position = vec4(p, 0.0, 1.0);\n"
                                  "}\n";
static const char fragment_text[] = "#version 330\n"
                                    "uniform sampler2D picture;\n"
                                    "in vec2 at;\n"
                                    "out vec4 color;\n"
                                    "void main() { color = texture(picture, at); }\n";

static GLuint shader(GLenum kind, const char *text, char why[256])
{
    GLint good = 0;
    const GLuint name = glCreateShader(kind);
    glShaderSource(name, 1, &text, NULL);
    glCompileShader(name);
    glGetShaderiv(name, GL_COMPILE_STATUS, &good);
    if (!good)
        glGetShaderInfoLog(name, 256, NULL, why);
    return name;
}

bool tc_view_draw_init(tc_view_draw *draw, char why[256])
{
    GLint good = 0;
    *why = 0;
    const GLuint vertex = shader(GL_VERTEX_SHADER, vertex_text, why);
    const GLuint fragment = shader(GL_FRAGMENT_SHADER, fragment_text, why);
    draw->program = glCreateProgram();
    glAttachShader(draw->program, vertex);
    glAttachShader(draw->program, fragment);
    glLinkProgram(draw->program);
    glDeleteShader(vertex);
    glDeleteShader(fragment);
    glGetProgramiv(draw->program, GL_LINK_STATUS, &good);
    if (!good && !*why)
        glGetProgramInfoLog(draw->program, 256, NULL, why);
    draw->stretch = glGetUniformLocation(draw->program, "stretch");
    glGenVertexArrays(1, &draw->vertex_array);
    glGenSamplers(2, draw->sampler);
    for (int i = 0; i < 2; i++) {
        glSamplerParameteri(draw->sampler[i], GL_TEXTURE_MIN_FILTER, i ? GL_LINEAR : GL_NEAREST);
        glSamplerParameteri(draw->sampler[i], GL_TEXTURE_MAG_FILTER, i ? GL_LINEAR : GL_NEAREST);
        glSamplerParameteri(draw->sampler[i], GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
        glSamplerParameteri(draw->sampler[i], GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    }
    return good != 0;
}

void tc_view_draw_finish(tc_view_draw *draw)
{
    glDeleteProgram(draw->program);
    glDeleteVertexArrays(1, &draw->vertex_array);
    glDeleteSamplers(2, draw->sampler);
    glDeleteTextures(1, &draw->figure.texture);
    *draw = (tc_view_draw){0};
}

void tc_view_draw_figure(tc_view_draw *draw, const tc_image *image)
{
    tc_layer *figure = &draw->figure;
    if (!image) {
        figure->rows = 0;
        return;
    }
    if (!figure->texture)
        glGenTextures(1, &figure->texture);
    glBindTexture(GL_TEXTURE_2D, figure->texture);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA16F, image->width, image->height, 0, GL_RGBA, GL_FLOAT, image->rgba);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
    glBindTexture(GL_TEXTURE_2D, 0);
    figure->width = image->width;
    figure->height = figure->rows = image->height;
    figure->stretch = 1;
}

static void draw_layer(const tc_view_draw *draw, const tc_layer *layer, int width, int height)
{
    glBindSampler(0, draw->sampler[layer->width != width || layer->height != height]);
    glBindTexture(GL_TEXTURE_2D, layer->texture);
    glUniform1f(draw->stretch, (float)layer->stretch);
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

void tc_view_draw_layers(const tc_view_draw *draw, const tc_shown *shown, const float background[3], int width,
                         int height)
{
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_DEPTH_TEST);
    glClearColor(background[0], background[1], background[2], 1);
    glClear(GL_COLOR_BUFFER_BIT);
    glUseProgram(draw->program);
    glBindVertexArray(draw->vertex_array);
    glActiveTexture(GL_TEXTURE0);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    if (shown->whole.texture)
        draw_layer(draw, &shown->whole, width, height);
    if (shown->over.texture && shown->over.rows > 0) {
        const int rows = (int)((long long)height * shown->over.rows / shown->over.height);
        glEnable(GL_SCISSOR_TEST);
        glScissor(0, height - rows, width, rows);
        glClear(GL_COLOR_BUFFER_BIT);
        draw_layer(draw, &shown->over, width, height);
        glDisable(GL_SCISSOR_TEST);
    }
    if (draw->figure.rows > 0)
        draw_layer(draw, &draw->figure, width, height);
    glDisable(GL_BLEND);
    glBindSampler(0, 0);
    glBindTexture(GL_TEXTURE_2D, 0);
    glBindVertexArray(0);
    glUseProgram(0);
}
