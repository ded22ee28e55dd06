/* tetcast_image.h: pictures, and their files. Included by tetcast.h. */
#ifndef TETCAST_IMAGE_H
#define TETCAST_IMAGE_H

#ifndef TETCAST_H
#error "include tetcast.h, which includes this file"
#endif

/* Premultiplied float RGBA, row 0 at the top. */
typedef struct tc_image {
    int width, height;
    float *rgba; /* [height][width][4] */
} tc_image;

struct tc_text_pair {
    const char *key, *value;
};

TC_API tc_status tc_image_create(tc_image **out, int width, int height, tc_error *err);
TC_API void tc_image_destroy(tc_image **image);
/* background over-composited in place: rgba premultiplied. */
TC_API void tc_image_background(tc_image *image, const float *rgba);
/* By extension png, exr, tif(f), jpg; "-": PNG to stdout. meta [n] may be NULL. Whole or not at all. */
TC_API tc_status tc_image_write(const tc_image *image, const char *path, const tc_text_pair *meta, size_t n,
                                const tc_log *log, tc_error *err);
TC_API tc_status tc_image_read(tc_image **out, const char *path, tc_error *err);
/* The text that a picture carries under a key of its metadata ("tetcast:" before it does not count), UTF-8, from malloc;
 * NULL: it carries none.
 * Errors: as tc_image_read; a PNG file that is cut short carries what is there. Cost: reads the file; of other formats as
 * tc_image_read. */
TC_API tc_status tc_image_read_text(char **out, const char *path, const char *key, tc_error *err);

/* Writes any number of pictures. PNG is encoded in this process; other formats by a helper program, which needs 0.2 s to
 * start and stays for the next ones. Not for two threads at a time. */
typedef struct tc_image_writer tc_image_writer;
/* Starts nothing. Errors: TC_E_MEMORY. */
TC_API tc_status tc_image_writer_create(tc_image_writer **out, tc_error *err);
/* Files named like path (a number may differ) are to come: starts the helper program if their format needs it, and
 * returns at once, so that its start passes while the caller does something else. Errors: TC_E_ARG (extension),
 * TC_E_WORKER; both are told again by tc_image_writer_save. */
TC_API tc_status tc_image_writer_expect(tc_image_writer *writer, const char *path, tc_error *err);
/* How a file holds its pixels; zeros are the defaults of each format. */
typedef struct tc_image_encoding {
    int bits;    /* a channel; PNG: 8 (default) or 16; EXR: 32 (default) or 16 (half); TIFF: 32; JPEG: 8 */
    int quality; /* JPEG: 1 to 100; 0: 95 */
    int level;   /* PNG: zlib's, 1 (large) to 9 (slow); 0: runs alone, quick; -1: not compressed */
    const float *depth; /* [height][width], borrowed: channel Z of EXR, 32 bits, any values; refused of other formats; NULL: none */
} tc_image_encoding;

/* tc_image_write through it; a helper that died is started anew. encoding may be NULL.
 * Errors: as tc_image_write; TC_E_ARG (an encoding that the format has not). */
TC_API tc_status tc_image_writer_save(tc_image_writer *writer, const tc_image *image, const char *path,
                                      const tc_image_encoding *encoding, const tc_text_pair *meta, size_t n,
                                      const tc_log *log, tc_error *err);
TC_API void tc_image_writer_destroy(tc_image_writer **writer);

/* A picture that is written row by row, from the top, while it is made: rows are held only until they are encoded. The file
 * appears whole when it is closed, or not at all. Up to 32768 x 32768 pixels, of every format and encoding but depth.
 * A pipe, a device or "-" gets PNG at once, which cannot be taken back, and other formats at the end. opaque: every pixel will
 * be (of PNG then without alpha); a pixel that is not is laid over black. Texts, path and *log are copied. Formats other than
 * PNG take a helper program of the stream's own. Errors: as tc_image_writer_save; TC_E_FILE tells of a disk that is full. */
typedef struct tc_image_stream tc_image_stream;
TC_API tc_status tc_image_stream_open(tc_image_stream **out, const char *path, int width, int height, bool opaque,
                                      const tc_image_encoding *encoding, const tc_text_pair *meta, size_t n,
                                      const tc_log *log, tc_error *err);
/* The next rows: rgba [rows][width][4], as of tc_image. */
TC_API tc_status tc_image_stream_rows(tc_image_stream *stream, const float *rgba, int rows, tc_error *err);
/* keep: all rows are there and the file is to be; else, or on an error, nothing of it stays. *stream is freed. */
TC_API tc_status tc_image_stream_close(tc_image_stream **stream, bool keep, tc_error *err);

/* Is a picture's file whole and undamaged, and of the format that its name says? *text (NULL allowed) gets the text under key,
 * as of tc_image_read_text. writer NULL: helpers start anew. Errors: TC_E_FILE (not there, empty, of another kind, cut short,
 * damaged: says which), TC_E_WORKER, TC_E_MEMORY. Cost: PNG: reads the file and
 * its checksums; other formats are decoded. */
TC_API tc_status tc_image_check(char **text, const char *path, const char *key, tc_image_writer *writer, tc_error *err);

typedef struct tc_compare_result {
    double max_abs, mean_abs, p999_abs, rms; /* over channels; mean and rms over pixels covered in either image */
    size_t pixels, covered, differing;       /* differing: a channel differs by more than 1/255 */
    int worst_x, worst_y;
} tc_compare_result;
/* Errors: TC_E_ARG when sizes differ. */
TC_API tc_status tc_image_compare(tc_compare_result *out, const tc_image *a, const tc_image *b, tc_error *err);

#endif
