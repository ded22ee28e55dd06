/* corrupt.c: damages every real file in many ways, gives each to the program, and counts what came of it.
 *
 *   corrupt TETCAST DATA [--variants N] [--most N] [--seed S] [--jobs N] [--only TEXT] [--list FILE] [--keep FOLDER]
 *
 * Each damaged file goes through `tetcast info` or `tetcast render` (64 x 64) under a limit of time and of memory. What
 * may come of it: it is refused with one sentence that names the file, and nothing is left behind; or it is read, since
 * the damage hit nothing that counts, or was mended and told; or the reader died of it, and the program says so in one
 * sentence. Never: the program dies or hangs, a picture half written, an error without a name. --list tells of
 * every file, --keep keeps the damaged files that killed the reader or went wrong. */
#define _GNU_SOURCE
#include "corrupt_files.h"

#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum { TIME_LIMIT_S = 20, JOBS_MAX = 64, VARIANTS = 15, FULL_LEAST = 500 /* files of a full run */ };
static const rlim_t memory_limit = (rlim_t)6 << 30;

typedef enum outcome { CLEAR, READ, DIED, UNCLEAR, LEFTOVER, SIGNALLED, HUNG, BROKEN, N_OUTCOME } outcome;
static const char *const outcome_name[] = {"refused",  "read",   "reader died", "UNCLEAR",
                                           "LEFTOVER", "SIGNAL", "HANG",        "NOT RUN"};

typedef struct settings {
    const char *tetcast, *data, *only, *list, *keep;
    size_t variants, most, jobs;
    uint64_t seed;
} settings;

typedef struct trial {
    size_t set, file, damage;
    uint64_t seed;
    bool render;
} trial;

/* Sent through a pipe: at most PIPE_BUF bytes, so it arrives whole. */
typedef struct result {
    size_t trial;
    int outcome, code;
    double seconds;
    char text[2048];
} result;

static double now_s(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* ------------------------------------------------------------------------------------------------------- one trial */

static void run_child(char *const *argv, const char *out, const char *err)
{
    struct rlimit core = {0, 0}, memory = {memory_limit, memory_limit};
    int null = open("/dev/null", O_RDONLY), o = open(out, O_WRONLY | O_CREAT | O_TRUNC, 0600),
        e = open(err, O_WRONLY | O_CREAT | O_TRUNC, 0600);
    setpgid(0, 0);
    setrlimit(RLIMIT_CORE, &core);
#ifndef TC_NO_MEMORY_LIMIT
    setrlimit(RLIMIT_AS, &memory);
#else
    (void)memory;
#endif
    if (null < 0 || o < 0 || e < 0 || dup2(null, 0) < 0 || dup2(o, 1) < 0 || dup2(e, 2) < 0)
        _exit(126);
    execv(argv[0], argv);
    _exit(127);
}

/* Runs argv; *status as of waitpid, false when it was stopped after the time limit. */
static bool run(int *status, char *const *argv, const char *out, const char *err)
{
    double end = now_s() + TIME_LIMIT_S;
    pid_t pid = fork();
    if (pid == 0)
        run_child(argv, out, err);
    for (;;) {
        struct timespec nap = {0, 3000000};
        pid_t r = waitpid(pid, status, WNOHANG);
        if (r == pid || (r < 0 && errno != EINTR))
            break;
        if (now_s() > end) {
            kill(-pid, SIGKILL);
            waitpid(pid, status, 0);
            return false;
        }
        nanosleep(&nap, NULL);
    }
    kill(-pid, SIGKILL); /* helpers that outlive it */
    return true;
}

static size_t read_text(char *out, size_t capacity, const char *path)
{
    FILE *file = fopen(path, "rb");
    size_t n = file ? fread(out, 1, capacity - 1, file) : 0;
    if (file)
        fclose(file);
    out[n] = 0;
    return n;
}

static size_t entries_of(const char *folder)
{
    struct dirent *entry;
    size_t n = 0;
    DIR *dir = opendir(folder);
    while (dir && (entry = readdir(dir)))
        n += strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0;
    if (dir)
        closedir(dir);
    return n;
}

static const char *base_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

/* One line, an error, that names one of the two files and has no strange characters in it? */
static bool is_clear(const char *text, const char *input, const char *damaged)
{
    static const char start[] = "tetcast: error: ";
    size_t n = strlen(text);
    if (strncmp(text, start, sizeof start - 1) != 0 || n < sizeof start + 16 || strchr(text, '\n') != text + n - 1)
        return false;
    for (size_t i = 0; i + 1 < n; i++)
        if (iscntrl((unsigned char)text[i]))
            return false;
    return strstr(text, base_name(input)) || strstr(text, base_name(damaged));
}

static outcome judge(int status, bool in_time, const trial *t, const char *text, size_t n_stdout, const char *out,
                     const char *input, const char *damaged)
{
    if (!in_time)
        return HUNG;
    if (WIFSIGNALED(status))
        return SIGNALLED;
    int code = WEXITSTATUS(status);
    if (code >= 126)
        return BROKEN;
    if (entries_of(out) != (code == 0 && t->render ? 1u : 0u))
        return LEFTOVER;
    if (code == 0)
        return t->render == (n_stdout > 0) || strstr(text, "error") ? UNCLEAR : READ;
    /* info tells what it found even where nothing of it can be rendered */
    if (code != 1 || !is_clear(text, input, damaged) || (n_stdout > 0 && t->render))
        return UNCLEAR;
    return strstr(text, "tetcast-read ended") || strstr(text, "was stopped") ? DIED : CLEAR;
}

static void try_one(result *r, const settings *s, const tc_datasets *sets, const trial *t, const char *scratch)
{
    size_t n_damage;
    const tc_damage *damage = tc_damage_list(&n_damage);
    const tc_dataset *set = &sets->set[t->set];
    const tc_dataset *next = &sets->set[(t->set + 1 + t->seed % (sets->n - 1)) % sets->n];
    char folder[2 * TC_PATH], out[2 * TC_PATH], picture[3 * TC_PATH], mesh[2 * TC_PATH], other[2 * TC_PATH + 1],
        log[2][2 * TC_PATH];
    char input[TC_PATH], damaged[TC_PATH];
    char *argv[24], step[16];
    size_t n = 0;
    struct stat st = {0};
    int status = 0;
    snprintf(folder, sizeof folder, "%s/in", scratch);
    snprintf(out, sizeof out, "%s/out", scratch);
    snprintf(log[0], sizeof log[0], "%s/stdout", scratch);
    snprintf(log[1], sizeof log[1], "%s/stderr", scratch);
    snprintf(picture, sizeof picture, "%s/picture.png", out);
    snprintf(mesh, sizeof mesh, "%s/vol/Tetrahedron.vtu", s->data);
    snprintf(other, sizeof other, "%s/%s", next->folder, next->file[t->seed / 7 % next->n_file]);
    mkdir(folder, 0700);
    mkdir(out, 0700);
    r->outcome = BROKEN;
    if (tc_damage_make(input, damaged, folder, set, t->file, &damage[t->damage], t->seed, other)) {
        argv[n++] = (char *)s->tetcast;
        argv[n++] = t->render ? "render" : "info";
        argv[n++] = set->map ? mesh : input;
        if (set->map)
            argv[n++] = "--color-map", argv[n++] = input;
        if (t->render) {
            argv[n++] = "--size", argv[n++] = "64x64", argv[n++] = "--output", argv[n++] = picture;
            argv[n++] = "--driver", argv[n++] = t->seed % 3 ? "reference" : "pingpong";
        }
        /* a time step's folder of OpenFOAM: that step */
        const char *relative = set->file[t->file];
        size_t digits = strspn(relative, "0123456789.");
        if (*set->input && digits > 0 && relative[digits] == '/') {
            snprintf(step, sizeof step, "%.*s", (int)digits, relative);
            argv[n++] = "--time", argv[n++] = step;
        }
        argv[n++] = "--idle-limit", argv[n++] = "10";
        if (t->seed % 4)
            argv[n++] = "--reentry", argv[n++] = "peel";
        argv[n] = NULL;
        double start = now_s();
        bool in_time = run(&status, argv, log[0], log[1]);
        r->seconds = now_s() - start;
        r->code = status;
        read_text(r->text, sizeof r->text, log[1]);
        stat(log[0], &st);
        r->outcome = (int)judge(status, in_time, t, r->text, (size_t)st.st_size, out, input, damaged);
    }
    if (s->keep && r->outcome >= DIED) {
        char kept[2 * TC_PATH];
        snprintf(kept, sizeof kept, "%s/%zu", s->keep, r->trial);
        mkdir(s->keep, 0700);
        if (rename(folder, kept) != 0)
            fprintf(stderr, "%s could not be kept as %s: %s\n", folder, kept, strerror(errno));
    }
    tc_folder_remove(folder);
    tc_folder_remove(out);
}

/* ------------------------------------------------------------------------------------------------------ all of them */

/* Every data set gets `variants` kinds of damage, in turn over all data sets and their files; sets of many files more.
 */
static size_t plan(trial **out, const settings *s, const tc_datasets *sets)
{
    size_t n_damage, n = 0, turn = 0, capacity = 0;
    tc_damage_list(&n_damage);
    *out = NULL;
    for (size_t k = 0; k < sets->n; k++) {
        const tc_dataset *set = &sets->set[k];
        size_t count = s->variants > set->n_file || s->variants < 4 ? s->variants : set->n_file;
        count = set->n_file > 1 && s->variants >= 4 ? 2 * count : count;
        for (size_t v = 0; v < count; v++, turn++) {
            if (n == capacity) {
                capacity = capacity ? 2 * capacity : 256;
                *out = realloc(*out, capacity * sizeof **out);
            }
            uint64_t place = s->seed * 1000003u + turn;
            trial t = {k, v % set->n_file, turn % n_damage, tc_random(&place), set->map || (turn + v) % 3 == 0};
            if (!s->only || strstr(set->file[t.file], s->only))
                (*out)[n++] = t;
        }
        turn += n_damage / 2 + 1; /* another first kind for the next one */
    }
    if (s->most > 0 && n > s->most) { /* evenly over all */
        for (size_t i = 0; i < s->most; i++)
            (*out)[i] = (*out)[i * n / s->most];
        n = s->most;
    }
    return n;
}

static void work(const settings *s, const tc_datasets *sets, const trial *all, size_t n, size_t job, int to)
{
    char scratch[TC_PATH];
    const char *folder = getenv("TMPDIR");
    snprintf(scratch, sizeof scratch, "%.900s/tetcast-corrupt-XXXXXX", folder && *folder ? folder : "/tmp");
    if (!mkdtemp(scratch))
        _exit(1);
    for (size_t i = job; i < n; i += s->jobs) {
        result r = {.trial = i};
        try_one(&r, s, sets, &all[i], scratch);
        if (write(to, &r, sizeof r) != (ssize_t)sizeof r)
            break;
    }
    tc_folder_remove(scratch);
    _exit(0);
}

static void print_table(size_t (*count)[N_OUTCOME], size_t n_row, const tc_damage *damage)
{
    size_t total[N_OUTCOME] = {0};
    printf("%-16s", "damage");
    for (int o = 0; o < N_OUTCOME; o++)
        printf(" %11s", outcome_name[o]);
    for (size_t k = 0; k < n_row; k++) {
        printf("\n%-16s", damage[k].name);
        for (int o = 0; o < N_OUTCOME; o++) {
            printf(" %11zu", count[k][o]);
            total[o] += count[k][o];
        }
    }
    printf("\n%-16s", "all");
    for (int o = 0; o < N_OUTCOME; o++)
        printf(" %11zu", total[o]);
    putchar('\n');
}

static int run_all(const settings *s, const tc_datasets *sets)
{
    size_t n_damage, bad = 0, seen = 0;
    const tc_damage *damage = tc_damage_list(&n_damage);
    trial *all;
    size_t n = plan(&all, s, sets);
    size_t(*count)[N_OUTCOME] = calloc(n_damage, sizeof *count);
    FILE *list = s->list ? fopen(s->list, "w") : NULL;
    int ends[2];
    double start = now_s(), longest = 0;
    if (!count || pipe2(ends, O_CLOEXEC) != 0)
        return 1;
    for (size_t j = 0; j < s->jobs; j++)
        if (fork() == 0)
            work(s, sets, all, n, j, ends[1]);
    close(ends[1]);
    for (result r; read(ends[0], &r, sizeof r) == (ssize_t)sizeof r; seen++) {
        const trial *t = &all[r.trial];
        const tc_dataset *set = &sets->set[t->set];
        bool wrong = r.outcome >= UNCLEAR;
        count[t->damage][r.outcome]++;
        longest = r.seconds > longest ? r.seconds : longest;
        if (wrong)
            printf("%s: %s of %s/%s, seed %llu, status %x\n%s", outcome_name[r.outcome], damage[t->damage].name,
                   base_name(set->folder), set->file[t->file], (unsigned long long)t->seed, (unsigned)r.code, r.text);
        bad += wrong;
        if (list)
            fprintf(list, "%s\t%s\t%s/%s\t%s\t%.2f\t%s%s", outcome_name[r.outcome], damage[t->damage].name,
                    base_name(set->folder), set->file[t->file], t->render ? "render" : "info", r.seconds, r.text,
                    *r.text ? "" : "\n");
    }
    while (wait(NULL) > 0)
        ;
    if (list)
        fclose(list);
    print_table(count, n_damage, damage);
    printf("%zu damaged files of %zu data sets, %zu wrong; %.0f s, the longest %.1f s\n", seen, sets->n, bad,
           now_s() - start, longest);
    free(all);
    free(count);
    if (s->variants >= VARIANTS && s->most == 0 && !s->only && seen < FULL_LEAST) {
        printf("fewer than %d: some of the real files are missing\n", FULL_LEAST);
        bad++;
    }
    return bad > 0 || seen != n || n == 0;
}

int main(int argc, char **argv)
{
    settings s = {.variants = VARIANTS, .jobs = (size_t)sysconf(_SC_NPROCESSORS_ONLN), .seed = 1};
    tc_datasets sets;
    if (argc < 3) {
        fprintf(stderr, "usage: corrupt TETCAST DATA [--variants N] [--most N] [--seed S] [--jobs N] [--only TEXT] "
                        "[--list FILE] [--keep FOLDER]\n");
        return 2;
    }
    s.tetcast = argv[1], s.data = argv[2];
    for (int i = 3; i + 1 < argc; i += 2) {
        size_t number = strtoull(argv[i + 1], NULL, 10);
        if (!strcmp(argv[i], "--variants"))
            s.variants = number;
        else if (!strcmp(argv[i], "--most"))
            s.most = number;
        else if (!strcmp(argv[i], "--seed"))
            s.seed = number;
        else if (!strcmp(argv[i], "--jobs"))
            s.jobs = number;
        else if (!strcmp(argv[i], "--only"))
            s.only = argv[i + 1];
        else if (!strcmp(argv[i], "--list"))
            s.list = argv[i + 1];
        else if (!strcmp(argv[i], "--keep"))
            s.keep = argv[i + 1];
    }
    s.jobs = s.jobs < 1 ? 1 : s.jobs > JOBS_MAX ? JOBS_MAX : s.jobs;
    if (!tc_datasets_find(&sets, s.data)) {
        printf("there are no real files in %s: skipped\n", s.data);
        return 77;
    }
    int64_t start = (int64_t)time(NULL);
    int code = run_all(&s, &sets);
    if (!tc_datasets_untouched(&sets, start))
        code = 1;
    tc_datasets_finish(&sets);
    return code;
}
