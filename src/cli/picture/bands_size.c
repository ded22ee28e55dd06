/* bands_size.c: which pictures are made at once, and which in bands. */
#include "cli/picture/bands_size.h"
#include "cli/picture/stereo_options.h"

/* The option that needs the picture whole; NULL: none. */
static const char *tc_whole_wanted(const tc_render_command *o)
{
    return o->error_image                   ? "--error-image"
           : o->has_verify                  ? "--verify"
           : o->has_repeat                  ? "--repeat"
           : o->error > 0                   ? "--error"
           : o->frame_time > 0              ? "--frame-time"
           : o->out.depth                   ? "--depth"
           : o->out.value                   ? "--value"
           : o->out.stereo > TC_STEREO_PAIR ? "--stereo"
                                            : NULL;
}

static bool tc_is_beyond(const tc_size *size, long long pixels)
{
    return size->width > TC_ONCE_SIDE || size->height > TC_ONCE_SIDE || (long long)size->width * size->height > pixels;
}

bool tc_bands_asked(const tc_render_command *options)
{
    return tc_is_beyond(&options->size, tc_whole_wanted(options) ? TC_WHOLE_PIXELS : TC_ONCE_PIXELS);
}

int tc_bands_check(const tc_render_command *options, tc_talk *talk)
{
    const char *whole = tc_whole_wanted(options);
    if (!whole || !tc_is_beyond(&options->size, TC_WHOLE_PIXELS))
        return -1;
    return tc_given_refuse(&options->given, talk, whole, "--size",
                           "%s needs the picture at once, and %dx%d pixels are made in bands: leave it out, or give a "
                           "--size of at most %d pixels in all and %d each way",
                           whole, options->size.width, options->size.height, TC_WHOLE_PIXELS, TC_ONCE_SIDE);
}
