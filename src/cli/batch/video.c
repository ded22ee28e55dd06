/* video.c: finished pictures become a video: ffmpeg takes them one after the other from its standard input, so that
 * their names are never read by it. */
#define _GNU_SOURCE
#include "cli/batch/video.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <signal.h>
#include <spawn.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

extern char **environ;

static const char install[] = "install it (Debian: apt install ffmpeg) or join the pictures with another program";

#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
static tc_status
fail(tc_error *err, tc_status code, const char *format, ...)
{
    if (err) {
        va_list rest;
        va_start(rest, format);
        vsnprintf(err->text, sizeof err->text, format, rest);
        va_end(rest);
        err->code = code;
    }
    return code;
}

typedef enum kind { KIND_NONE = 0, KIND_H264, KIND_VP9, KIND_GIF } kind;

static const struct {
    const char *end, *format;
    kind kind;
} container[] = {
    {".mp4", "mp4", KIND_H264}, {".mov", "mov", KIND_H264}, {".webm", "webm", KIND_VP9}, {".gif", "gif", KIND_GIF}};

/* Index into container[]; -1: no video's name. */
static int container_of(const char *path)
{
    size_t length = strlen(path);
    for (int i = 0; i < (int)(sizeof container / sizeof *container); i++) {
        size_t end = strlen(container[i].end);
        if (length > end && path[length - end - 1] != '/' && !strcasecmp(path + length - end, container[i].end))
            return i;
    }
    return -1;
}

bool tc_video_is_name(const char *path)
{
    return container_of(path) >= 0;
}

bool tc_video_is_possible(char *why, size_t capacity)
{
    char file[4096];
    const char *at = getenv("PATH");
    while (at) {
        size_t n = strcspn(at, ":");
        int length = snprintf(file, sizeof file, "%.*s%sffmpeg", (int)n, at, n ? "/" : "");
        struct stat info;
        if (length > 0 && (size_t)length < sizeof file && stat(file, &info) == 0 && S_ISREG(info.st_mode) &&
            access(file, X_OK) == 0)
            return true;
        at = at[n] ? at + n + 1 : NULL;
    }
    if (why)
        snprintf(why, capacity, "videos need ffmpeg, which is not installed; %s", install);
    return false;
}

/* Pictures. */

typedef struct picture {
    unsigned width, height;
    bool png, alpha;
} picture;

static unsigned big(const unsigned char *p, int n)
{
    unsigned value = 0;
    for (int i = 0; i < n; i++)
        value = value << 8 | p[i];
    return value;
}

/* Size and kind of a whole PNG or JPEG file in memory; else a word on what is wrong. */
static const char *look(picture *out, const unsigned char *p, size_t n)
{
    static const unsigned char png[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'},
                               end[] = {'I', 'E', 'N', 'D', 0xAE, 0x42, 0x60, 0x82};
    *out = (picture){0};
    if (n >= 45 && memcmp(p, png, 8) == 0) {
        *out = (picture){big(p + 16, 4), big(p + 20, 4), true, (p[25] & 4) != 0};
        for (size_t at = 33; !out->alpha && at + 12 <= n && memcmp(p + at + 4, "IDAT", 4) != 0;
             at += 12 + (size_t)big(p + at, 4))
            out->alpha = memcmp(p + at + 4, "tRNS", 4) == 0;
        return memcmp(p + n - 8, end, 8) != 0 ? "is cut" : out->width && out->height ? NULL : "is damaged";
    }
    if (n < 4 || p[0] != 0xFF || p[1] != 0xD8)
        return "is neither a PNG nor a JPEG file";
    for (size_t at = 2; at + 9 < n && p[at] == 0xFF; at += 2 + big(p + at + 2, 2)) {
        if ((p[at + 1] & 0xF0) == 0xC0 && p[at + 1] != 0xC4 && p[at + 1] != 0xC8 && p[at + 1] != 0xCC) {
            *out = (picture){big(p + at + 7, 2), big(p + at + 5, 2), false, false};
            return p[n - 2] != 0xFF || p[n - 1] != 0xD9 ? "is cut" : out->width && out->height ? NULL : "is damaged";
        }
    }
    return "is damaged";
}

/* All of a picture's file; the caller frees *data. */
static tc_status read_picture(unsigned char **data, size_t *bytes, picture *out, const char *path, tc_error *err)
{
    struct stat info;
    *data = NULL;
    *bytes = 0;
    int file = open(path, O_RDONLY | O_CLOEXEC), code = file < 0 ? errno : 0;
    if (!code && fstat(file, &info) != 0)
        code = errno;
    if (!code && !S_ISREG(info.st_mode))
        code = EINVAL;
    if (!code && !(*data = malloc((size_t)info.st_size + 1)))
        code = ENOMEM;
    while (!code && *bytes < (size_t)info.st_size) {
        ssize_t got = read(file, *data + *bytes, (size_t)info.st_size - *bytes);
        if (got == 0)
            break;
        if (got > 0)
            *bytes += (size_t)got;
        else if (errno != EINTR)
            code = errno;
    }
    if (file >= 0)
        close(file);
    const char *wrong = code ? strerror(code) : look(out, *data, *bytes);
    if (!wrong)
        return TC_OK;
    free(*data);
    *data = NULL;
    return fail(err, code == ENOMEM ? TC_E_MEMORY : TC_E_FILE,
                "the picture %s %s%s; render it again, and make the video then", path, code ? "cannot be read: " : "",
                wrong);
}

/* ffmpeg. */

typedef struct work {
    const char *path;
    const tc_video_options *options;
    size_t n;
    char *part;      /* what ffmpeg writes */
    int lock;        /* it, opened; -1: not yet */
    int input, talk; /* ffmpeg's standard input, and a file that takes what it says */
    pid_t child;     /* 0: none */
    bool refused;    /* ffmpeg takes no more frames */
} work;

enum { ARGUMENTS_MAX = 64 };
typedef struct arguments {
    char *v[ARGUMENTS_MAX + 1], text[1024];
    size_t n, used;
} arguments;

#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
static void
argument(arguments *out, const char *format, ...)
{
    va_list rest;
    size_t room = sizeof out->text - out->used;
    va_start(rest, format);
    int length = vsnprintf(out->text + out->used, room, format, rest);
    va_end(rest);
    if (length < 0 || (size_t)length >= room || out->n >= ARGUMENTS_MAX)
        abort(); /* all but the file's name, which is not put here, has a known length */
    out->v[out->n++] = out->text + out->used;
    out->used += (size_t)length + 1;
}

static void argument_list(arguments *out, const char *const *list)
{
    for (; *list; list++)
        argument(out, "%s", *list);
}

/* file: "file:" and the name of what is to be written. */
static void command(arguments *out, const work *w, const picture *first, int which, char *file)
{
    static const char *const begin[] = {"ffmpeg",  "-hide_banner", "-loglevel",        "error", "-nostdin",   "-y",
                                        "-xerror", "-err_detect",  "crccheck+explode", "-f",    "image2pipe", NULL};
    static const char *const colours[] = {
        "-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "bt709", "-color_range", "tv", NULL};
    /* Four threads on any machine: the encoders' bytes may depend on it. */
    static const char *const end[] = {"-map_metadata", "-1",       "-fflags", "+bitexact", "-flags:v",
                                      "+bitexact",     "-threads", "4",       NULL};
    const kind is = container[which].kind;
    const double fps = w->options->fps > 0 ? w->options->fps : 24;
    const int quality = w->options->quality > 0 ? w->options->quality : 75;
    const bool keep = first->alpha && is == KIND_VP9;
    char filter[512];
    size_t at = 0;
    filter[0] = 0;
    argument_list(out, begin);
    argument(out, "-framerate");
    argument(out, "%lld/1000", llround(fps * 1000));
    argument(out, "-c:v");
    argument(out, first->png ? "png" : "mjpeg");
    argument(out, "-i");
    argument(out, "pipe:0");
    if (first->alpha && !keep) /* the same picture, all white and opaque, lies below */
        at += (size_t)snprintf(filter + at, sizeof filter - at,
                               "format=rgba,split[over][below];[below]lutrgb=r=255:g=255:b=255:a=255[white];"
                               "[white][over]overlay=format=gbrp,");
    if (is != KIND_GIF && (first->width % 2 || first->height % 2))
        at += (size_t)snprintf(filter + at, sizeof filter - at,
                               "format=%s,pad=%u:%u:0:0,fillborders=right=%u:bottom=%u:mode=smear,",
                               keep ? "gbrap" : "gbrp", first->width + first->width % 2,
                               first->height + first->height % 2, first->width % 2, first->height % 2);
    if (is == KIND_GIF)
        snprintf(
            filter + at, sizeof filter - at,
            "format=rgb24,split[one][two];[one]palettegen=stats_mode=single[colours];[two][colours]paletteuse=new=1");
    else
        snprintf(filter + at, sizeof filter - at,
                 "scale=flags=bicubic+accurate_rnd+full_chroma_int:out_color_matrix=bt709:out_range=tv,format=%s",
                 keep ? "yuva420p" : "yuv420p");
    argument(out, "-filter_complex");
    argument(out, "[0:v]%s", filter);
    if (is == KIND_H264) {
        static const char *const h264[] = {"-c:v", "libx264", "-preset", "medium", "-movflags", "+faststart", NULL};
        argument_list(out, h264);
        argument(out, "-crf");
        argument(out, "%d", (int)lround(42 - 0.32 * quality));
    } else if (is == KIND_VP9) {
        static const char *const vp9[] = {"-c:v",          "libvpx-vp9", "-b:v", "0",       "-deadline",
                                          "good",          "-cpu-used",  "2",    "-row-mt", "0",
                                          "-tile-columns", "1",          NULL};
        argument_list(out, vp9);
        argument(out, "-crf");
        argument(out, "%d", (int)lround(60 - 0.45 * quality));
        if (keep) {
            argument(out, "-auto-alt-ref"); /* alternate references and transparency do not go together */
            argument(out, "0");
        }
    } else {
        argument(out, "-loop");
        argument(out, "0");
    }
    if (is != KIND_GIF)
        argument_list(out, colours);
    argument_list(out, end);
    argument(out, "-f");
    argument(out, "%s", container[which].format);
    out->v[out->n++] = file;
    out->v[out->n] = NULL;
}

static tc_status cannot_write(const work *w, int code, tc_error *err)
{
    return fail(err, TC_E_FILE, "%s cannot be written: %s; %s", w->path, strerror(code),
                code == ENOENT   ? "make its folder first"
                : code == EISDIR ? "give a file name, not a folder"
                : code == ENOSPC ? "free some space or choose another place"
                                 : "choose another place");
}

/* Makes and locks the file that ffmpeg is to fill. */
static tc_status take_part(work *w, tc_error *err)
{
    struct stat info;
    const char *slash = strrchr(w->path, '/');
    int folder = slash ? (int)(slash - w->path) + 1 : 0;
    if (stat(w->path, &info) == 0 && S_ISDIR(info.st_mode))
        return cannot_write(w, EISDIR, err);
    if (asprintf(&w->part, "file:%.*s.%s.part", folder, w->path, w->path + folder) < 0) {
        w->part = NULL;
        return fail(err, TC_E_MEMORY, "memory ran out for %s; free some", w->path);
    }
    w->lock = open(w->part + 5, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (w->lock < 0)
        return cannot_write(w, errno, err);
    if (flock(w->lock, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
        close(w->lock);
        w->lock = -1; /* the file stays the other's */
        return fail(err, TC_E_FILE, "%s is being made by another process; wait for it, or choose another name",
                    w->path);
    }
    return TC_OK;
}

static tc_status start(work *w, const picture *first, int which, tc_error *err)
{
    arguments list = {.n = 0};
    posix_spawn_file_actions_t files;
    posix_spawnattr_t attributes;
    int pair[2];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, pair) != 0) /* no SIGPIPE, as a pipe has it */
        return fail(err, TC_E_WORKER, "ffmpeg cannot be run: %s; close some files", strerror(errno));
    w->input = pair[1];
    w->talk = memfd_create("ffmpeg", MFD_CLOEXEC);
    command(&list, w, first, which, w->part);
    int code = w->talk < 0 ? errno : posix_spawn_file_actions_init(&files);
    if (code == 0) {
        code = posix_spawn_file_actions_adddup2(&files, pair[0], STDIN_FILENO);
        code = code ? code : posix_spawn_file_actions_adddup2(&files, w->talk, STDOUT_FILENO);
        code = code ? code : posix_spawn_file_actions_adddup2(&files, w->talk, STDERR_FILENO);
        code = code ? code : posix_spawnattr_init(&attributes);
        if (code == 0) {
            sigset_t none;
            sigemptyset(&none);
            posix_spawnattr_setsigmask(&attributes, &none);
            posix_spawnattr_setpgroup(&attributes, 0); /* Ctrl-C is ours to answer */
            posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK);
            code = posix_spawnp(&w->child, "ffmpeg", &files, &attributes, list.v, environ);
            posix_spawnattr_destroy(&attributes);
        }
        posix_spawn_file_actions_destroy(&files);
    }
    close(pair[0]);
    if (code == 0)
        return TC_OK;
    w->child = 0;
    if (code == ENOENT)
        return fail(err, TC_E_WORKER, "%s needs ffmpeg, which is not installed; %s", w->path, install);
    return fail(err, TC_E_WORKER, "%s needs ffmpeg, which cannot be run: %s; %s", w->path, strerror(code), install);
}

/* Does the caller want the video? Else *err gets its sentence. */
static tc_status asked(const work *w, size_t frame, tc_error *err)
{
    if (!w->options->go_on || w->options->go_on(w->options->user, frame, w->n))
        return TC_OK;
    return fail(err, TC_E_CANCEL, "%s was not made: stopped", w->path);
}

/* Sends all bytes; w->refused is set where ffmpeg takes no more. */
static tc_status hand_over(work *w, const unsigned char *data, size_t bytes, size_t frame, tc_error *err)
{
    while (bytes > 0) {
        ssize_t put = send(w->input, data, bytes < (1u << 20) ? bytes : (1u << 20), MSG_NOSIGNAL);
        if (put > 0) {
            data += put;
            bytes -= (size_t)put;
        } else if (put < 0 && errno == EINTR) {
            tc_status status = asked(w, frame, err);
            if (status != TC_OK)
                return status;
        } else {
            w->refused = true;
            break;
        }
    }
    return TC_OK;
}

/* Waits for ffmpeg; *how is its status as of waitpid. TC_E_CANCEL: it still runs. */
static tc_status wait_for(work *w, int *how, tc_error *err)
{
    for (;;) {
        pid_t got = waitpid(w->child, how, w->options->go_on ? WNOHANG : 0);
        if (got == w->child || (got < 0 && errno != EINTR))
            break;
        tc_status status = asked(w, w->n, err);
        if (status != TC_OK)
            return status;
        if (w->options->go_on)
            nanosleep(&(struct timespec){0, 10000000}, NULL);
    }
    w->child = 0;
    return TC_OK;
}

/* The sentence of a failed ffmpeg: the last line that it said. */
static tc_status say_last_line(const work *w, int how, tc_error *err)
{
    char text[4096];
    struct stat info;
    off_t from =
        fstat(w->talk, &info) == 0 && info.st_size >= (off_t)sizeof text ? info.st_size - (off_t)sizeof text + 1 : 0;
    ssize_t n = pread(w->talk, text, sizeof text - 1, from);
    text[n > 0 ? n : 0] = 0;
    for (n = (ssize_t)strlen(text); n > 0 && strchr(" \t\r\n", text[n - 1]); n--)
        text[n - 1] = 0;
    char *line = text;
    for (char *p = text; *p; p++) {
        if (*p == '\n' || *p == '\r')
            line = p + 1;
        else if ((unsigned char)*p < ' ')
            *p = ' ';
    }
    if (WIFSIGNALED(how))
        return fail(err, TC_E_WORKER,
                    "%s was not made: ffmpeg was ended by signal %d%s%s; the pictures are whole, make it again",
                    w->path, WTERMSIG(how), *line ? ": " : "", line);
    return fail(err, TC_E_WORKER,
                "%s was not made: ffmpeg failed: %s; the pictures are whole, mend that and make it again", w->path,
                *line ? line : "it did not say why");
}

/* Looks at all pictures before anything is begun: *out gets the first one's size and kind, and whether any has alpha.
 */
static tc_status look_at_all(picture *out, const work *w, const char *const *frame, tc_error *err)
{
    for (size_t i = 0; i < w->n; i++) {
        unsigned char *data;
        size_t bytes;
        picture is;
        tc_status status = read_picture(&data, &bytes, &is, frame[i], err);
        free(data);
        if (status != TC_OK)
            return status;
        if (i == 0)
            *out = is;
        if (is.width != out->width || is.height != out->height || is.png != out->png)
            return fail(
                err, TC_E_FILE,
                "%s was not made: %s is a %s file of %ux%u and %s is a %s file of %ux%u; give pictures of one size "
                "and kind",
                w->path, frame[i], is.png ? "PNG" : "JPEG", is.width, is.height, frame[0], out->png ? "PNG" : "JPEG",
                out->width, out->height);
        out->alpha = out->alpha || is.alpha;
    }
    return TC_OK;
}

/* Hands over all frames. */
static tc_status feed(work *w, const char *const *frame, tc_error *err)
{
    tc_status status = TC_OK;
    for (size_t i = 0; i < w->n && status == TC_OK && !w->refused; i++) {
        unsigned char *data;
        size_t bytes;
        picture is;
        status = asked(w, i, err);
        if (status == TC_OK)
            status = read_picture(&data, &bytes, &is, frame[i], err);
        if (status != TC_OK)
            break;
        status = hand_over(w, data, bytes, i, err);
        free(data);
    }
    return status;
}

static tc_status finish(work *w, tc_error *err)
{
    struct stat info;
    int how = 0;
    shutdown(w->input, SHUT_WR);
    tc_status status = wait_for(w, &how, err);
    if (status != TC_OK)
        return status;
    if (how != 0 || w->refused || stat(w->part + 5, &info) != 0 || info.st_size == 0)
        return say_last_line(w, how, err);
    return rename(w->part + 5, w->path) != 0 ? cannot_write(w, errno, err) : TC_OK;
}

tc_status tc_video_make(const char *path, const char *const *frame, size_t n, const tc_video_options *options,
                        tc_error *err)
{
    static const tc_video_options usual = {0};
    work w = {.path = path, .options = options ? options : &usual, .n = n, .lock = -1, .input = -1, .talk = -1};
    const int which = container_of(path);
    picture first;
    if (which < 0)
        return fail(err, TC_E_ARG, "%s is no name of a video; give one that ends in .mp4, .mov, .webm or .gif", path);
    if (n == 0)
        return fail(err, TC_E_ARG, "there is no picture for %s; give one", path);
    if (!(w.options->fps == 0 || (w.options->fps >= 0.01 && w.options->fps <= 1000)))
        return fail(err, TC_E_ARG, "%g pictures a second are not possible for %s; give 0.01 to 1000", w.options->fps,
                    path);
    if (w.options->quality < 0 || w.options->quality > 100)
        return fail(err, TC_E_ARG, "the quality %d of %s is not known; give 1 to 100", w.options->quality, path);
    tc_status status = look_at_all(&first, &w, frame, err);
    if (status != TC_OK)
        return status;
    status = take_part(&w, err);
    if (status == TC_OK)
        status = start(&w, &first, which, err);
    if (status == TC_OK)
        status = feed(&w, frame, err);
    if (status == TC_OK)
        status = finish(&w, err);
    if (w.child > 0) {
        kill(-w.child, SIGKILL); /* and what it started */
        while (waitpid(w.child, NULL, 0) < 0 && errno == EINTR)
            ;
    }
    if (w.lock >= 0 && status != TC_OK)
        unlink(w.part + 5);
    const int open_file[] = {w.lock, w.input, w.talk};
    for (size_t i = 0; i < 3; i++)
        if (open_file[i] >= 0)
            close(open_file[i]);
    free(w.part);
    return status;
}
