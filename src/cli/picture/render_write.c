/* render_write.c: from a rendered picture to its files. */
#define _GNU_SOURCE
#include "cli/picture/render_write.h"
#include "cli/picture/render_figure.h"

#include <stdlib.h>
#include <string.h>

int tc_picture_dress(tc_render_run *run, tc_talk *talk)
{
    tc_error err = {0};
    tc_figure figure;
    if (run->options->background.there)
        tc_image_background(run->image, run->options->background.rgba);
    tc_status status = tc_render_figure(&figure, run) ? tc_figure_draw(run->image, &figure, &talk->log, &err) : TC_OK;
    return status ? tc_talk_status(talk, status, &err) : -1;
}

int tc_picture_file_make(tc_picture_file *out, tc_render_run *run, const char *path, int argc, char **argv,
                         tc_talk *talk)
{
    *out = (tc_picture_file){.path = strdup(path), .encoding = tc_output_encoding(&run->options->out, path)};
    if (!out->path) {
        tc_talk_error(talk, "memory ran out");
        return TC_EXIT_FAILED;
    }
    tc_meta_make(&out->meta, run, argc, argv);
    out->image = run->image;
    run->image = NULL;
    return -1;
}

tc_status tc_picture_file_write(const tc_picture_file *file, tc_image_writer *writer, const tc_log *log, tc_error *err)
{
    tc_image_writer *own = NULL;
    tc_image_encoding encoding = file->encoding;
    encoding.depth = file->depth;
    tc_status status = writer ? TC_OK : tc_image_writer_create(&own, err);
    if (status == TC_OK)
        status = tc_image_writer_save(writer ? writer : own, file->image, file->path, &encoding, file->meta.pair,
                                      file->meta.n, log, err);
    tc_image_writer_destroy(&own);
    return status;
}

void tc_picture_file_finish(tc_picture_file *file)
{
    free(file->path);
    tc_image_destroy(&file->image);
    free(file->depth);
    tc_meta_finish(&file->meta);
    *file = (tc_picture_file){0};
}
