/* worker.c: runs a helper program, talks to it, and says clearly how it ended. */
#define _GNU_SOURCE
#include "core/worker.h"
#include "core/locate.h"
#include "core/memory.h"
#include "core/parallel.h"
#include "core/wire.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum { TALK = 4096, FIRST_FREE = 10, LINGER_MS = 2000 };

/* The largest helper so far: a number of the process, as getrusage keeps them; nothing depends on it. */
static atomic_size_t peak_of_all;

struct tc_worker {
    char *name;
    tc_worker_limits limits; /* TC_WORKER_MACHINE as a number */
    bool machine;            /* it was that */
    pid_t pid;
    int pidfd;    /* -1: the kernel has none */
    int socket;   /* ours; -1: closed */
    int talk;     /* what the helper prints; -1: closed */
    bool running; /* not reaped yet */
    tc_wire_in in;
    size_t peak_bytes;
    size_t n_tail;
    char tail[TALK]; /* the end of what it printed */
};

size_t tc_worker_peak_bytes(void)
{
    return atomic_load(&peak_of_all);
}

/* ---------------------------------------------------------------------------------------------------- spawning */

/* Moves a descriptor out of the way of 0..3 in the child; closes the old one. */
static int move_up(int fd)
{
    int up = fcntl(fd, F_DUPFD_CLOEXEC, FIRST_FREE);
    int saved = errno;
    close(fd);
    errno = saved;
    return up;
}

/* A copy of the environment with the memory limit in it; *slot is the string to free. */
static char **environment_with(size_t memory_bytes, char **slot)
{
    size_t n = 0, m = 0;
    while (environ && environ[n])
        n++;
    char **copy = tc_alloc(n + 2, sizeof *copy);
    if (!copy || asprintf(slot, TC_WIRE_MEMORY "=%zu", memory_bytes) < 0) {
        *slot = NULL;
        free(copy);
        return NULL;
    }
    for (size_t i = 0; i < n; i++)
        if (strncmp(environ[i], TC_WIRE_MEMORY "=", sizeof TC_WIRE_MEMORY) != 0)
            copy[m++] = environ[i];
    copy[m++] = *slot;
    copy[m] = NULL;
    return copy;
}

/* The least memory limit of the program's control group and those around it (Linux, version 2); 0: none is known.
 * /proc/self/cgroup holds the line "0::/path" for it. */
static size_t group_memory(void)
{
    char line[1024], path[1200], *group = NULL;
    size_t least = 0;
    FILE *file = fopen("/proc/self/cgroup", "re");
    while (file && !group && fgets(line, sizeof line, file))
        if (strncmp(line, "0::/", 4) == 0)
            group = line + 3;
    if (file)
        fclose(file);
    if (!group)
        return 0;
    group[strcspn(group, "\n")] = 0;
    for (char *end = group + strlen(group); end; end = strrchr(group, '/')) {
        *end = 0;
        unsigned long long most;
        snprintf(path, sizeof path, "/sys/fs/cgroup%s/memory.max", group);
        file = fopen(path, "re");
        if (file && fscanf(file, "%llu", &most) == 1 && most > 0 && most <= SIZE_MAX && (least == 0 || most < least))
            least = (size_t)most;
        if (file)
            fclose(file);
    }
    return least;
}

/* 0: not known. */
static size_t machine_memory(void)
{
    const long pages = sysconf(_SC_PHYS_PAGES), page = sysconf(_SC_PAGESIZE);
    size_t bytes = pages > 0 && page > 0 ? (size_t)pages * (size_t)page : 0;
    size_t group = group_memory();
    bytes = group > 0 && (bytes == 0 || group < bytes) ? group : bytes;
    return bytes - bytes / 8;
}

/* Signals that this program has a handler for, or ignores (nohup, jobs in the background): it goes on, or wants to end its
 * work in order, for which it needs its helpers, whom the terminal or a scheduler sends them, too. */
static void add_handled(sigset_t *out)
{
    static const int number[] = {SIGINT, SIGTERM, SIGHUP, SIGQUIT};
    for (size_t i = 0; i < sizeof number / sizeof *number; i++) {
        struct sigaction now;
        if (sigaction(number[i], NULL, &now) == 0 && now.sa_handler != SIG_DFL)
            sigaddset(out, number[i]);
    }
}

/* What the child does with its descriptors and signals: 0 is /dev/null, 1 and 2 are the talk pipe, 3 is the socket. */
static int prepare_spawn(posix_spawn_file_actions_t *files, posix_spawnattr_t *attributes, int socket, int talk)
{
    sigset_t blocked, standard;
    sigemptyset(&blocked);
    add_handled(&blocked);
    sigemptyset(&standard);
    static const int reset[] = {SIGPIPE, SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGCHLD, SIGALRM, SIGUSR1, SIGUSR2, SIGXFSZ};
    for (size_t i = 0; i < sizeof reset / sizeof *reset; i++)
        sigaddset(&standard, reset[i]);
    int code = posix_spawn_file_actions_addopen(files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    code = code ? code : posix_spawn_file_actions_adddup2(files, talk, STDOUT_FILENO);
    code = code ? code : posix_spawn_file_actions_adddup2(files, talk, STDERR_FILENO);
    code = code ? code : posix_spawn_file_actions_adddup2(files, socket, TC_WIRE_SOCKET);
#if defined(__GLIBC__) && __GLIBC_PREREQ(2, 34)
    code = code ? code : posix_spawn_file_actions_addclosefrom_np(files, TC_WIRE_SOCKET + 1);
#endif
    code = code ? code : posix_spawnattr_setsigmask(attributes, &blocked);
    code = code ? code : posix_spawnattr_setsigdefault(attributes, &standard);
    return code ? code : posix_spawnattr_setflags(attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
}

static int spawn(tc_worker *w, const char *path, int socket, int talk)
{
    posix_spawn_file_actions_t files;
    posix_spawnattr_t attributes;
    char *slot = NULL, *argv[] = {w->name, NULL};
    char **environment = environment_with(w->limits.memory_bytes, &slot);
    if (!environment)
        return ENOMEM;
    int code = posix_spawn_file_actions_init(&files);
    if (code == 0) {
        code = posix_spawnattr_init(&attributes);
        if (code == 0) {
            code = prepare_spawn(&files, &attributes, socket, talk);
            code = code ? code : posix_spawn(&w->pid, path, &files, &attributes, argv, environment);
            posix_spawnattr_destroy(&attributes);
        }
        posix_spawn_file_actions_destroy(&files);
    }
    free(environment);
    free(slot);
    return code;
}

tc_status tc_worker_start(tc_worker **out, const char *name, const tc_worker_limits *limits, tc_error *err)
{
    tc_status status;
    char *path = NULL;
    int pair[2] = {-1, -1}, pipes[2] = {-1, -1}, code = 0;
    tc_worker *w = tc_calloc(1, sizeof *w);
    *out = NULL;
    if (!w)
        return tc_fail_memory(err, "a helper program", 1, sizeof *w);
    w->pidfd = w->socket = w->talk = -1;
    tc_wire_in_init(&w->in);
    if (limits)
        w->limits = *limits;
    w->machine = w->limits.memory_bytes == TC_WORKER_MACHINE;
    if (w->machine)
        w->limits.memory_bytes = machine_memory();
    w->name = tc_strdup(name);
    if (!w->name) {
        status = tc_fail_memory(err, "a helper program", 1, 64);
        goto done;
    }
    status = tc_locate_helper(&path, name, err);
    if (status != TC_OK)
        goto done;
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, pair) != 0 || pipe2(pipes, O_CLOEXEC) != 0 ||
        (pair[1] = move_up(pair[1])) < 0 || (pipes[1] = move_up(pipes[1])) < 0 ||
        fcntl(pipes[0], F_SETFL, O_NONBLOCK) != 0)
        code = errno;
    code = code ? code : spawn(w, path, pair[1], pipes[1]);
    if (code != 0) {
        status = tc_fail(err, TC_E_WORKER, "%s could not be started: %s", path, strerror(code));
        goto done;
    }
    w->running = true;
#ifdef SYS_pidfd_open
    w->pidfd = (int)syscall(SYS_pidfd_open, w->pid, 0); /* survives a host that reaps our child and gets its id again */
#endif
    w->socket = pair[0], w->talk = pipes[0];
    pair[0] = pipes[0] = -1;
    *out = w;
    w = NULL;
done:
    for (int i = 0; i < 2; i++) {
        if (pair[i] >= 0)
            close(pair[i]);
        if (pipes[i] >= 0)
            close(pipes[i]);
    }
    free(path);
    if (w)
        free(w->name);
    free(w);
    return status;
}

/* -------------------------------------------------------------------------------------------------------- ending */

/* Keeps the end of what the helper printed. Reads a bounded amount: a helper that prints without end must not hold us.
 */
static void drain(tc_worker *w)
{
    char chunk[TALK];
    for (int i = 0; i < 32 && w->talk >= 0; i++) {
        ssize_t n = read(w->talk, chunk, sizeof chunk);
        if (n < 0 && errno == EINTR)
            continue;
        if (n < 0 && (errno == EAGAIN || errno == EWOULDBLOCK))
            return;
        if (n <= 0) {
            close(w->talk);
            w->talk = -1;
            return;
        }
        size_t keep = w->n_tail + (size_t)n > TALK ? TALK - (size_t)n : w->n_tail;
        memmove(w->tail, w->tail + (w->n_tail - keep), keep);
        memcpy(w->tail + keep, chunk, (size_t)n);
        w->n_tail = keep + (size_t)n;
    }
}

/* Copies the last line that is not blank into out, made fit for a sentence; "" when there is none. */
static void last_line(char *out, size_t size, const tc_worker *w)
{
    size_t end = w->n_tail, begin, n = 0;
    while (end > 0 && (unsigned char)w->tail[end - 1] <= ' ')
        end--;
    for (begin = end; begin > 0 && w->tail[begin - 1] != '\n'; begin--)
        ;
    while (begin < end && (unsigned char)w->tail[begin] <= ' ')
        begin++;
    for (; begin < end && n + 1 < size; begin++, n++)
        out[n] = (unsigned char)w->tail[begin] < ' ' || w->tail[begin] == 0x7f ? ' ' : w->tail[begin];
    out[n] = 0;
}

/* How the helper ended: known, wait status in *how; unknown, since another part of the program collected it. */
typedef enum ending { RUNS, ENDED, ENDED_UNKNOWN } ending;

static ending collect(tc_worker *w, int *how)
{
    for (;;) {
        if (w->pidfd >= 0) {
            siginfo_t info = {0};
            int r = waitid((idtype_t)3 /* P_PIDFD */, (id_t)w->pidfd, &info, WEXITED | WNOHANG);
            if (r == 0 && info.si_pid == 0)
                return RUNS;
            if (r == 0) {
                *how = info.si_code == CLD_EXITED ? (info.si_status & 0xff) << 8 : info.si_status & 0x7f;
                return ENDED;
            }
        } else {
            pid_t r = waitpid(w->pid, how, WNOHANG);
            if (r == 0)
                return RUNS;
            if (r == w->pid)
                return ENDED;
        }
        if (errno != EINTR)
            return ENDED_UNKNOWN; /* ECHILD */
    }
}

/* Waits at most `ms`; drains what it prints meanwhile, so that it cannot block on a full pipe. */
static ending collect_within(tc_worker *w, int *how, double ms)
{
    double end = tc_now_ms() + ms;
    for (;;) {
        drain(w);
        ending e = collect(w, how);
        double left = end - tc_now_ms();
        if (e != RUNS) {
            w->running = false;
            drain(w);
            return e;
        }
        if (left <= 0)
            return RUNS;
        struct pollfd p[2] = {{.fd = w->pidfd, .events = POLLIN}, {.fd = w->talk, .events = POLLIN}};
        int slice = w->pidfd < 0 && left > 5 ? 5 : (int)left + 1;
        poll(p, 2, slice);
    }
}

static void send_kill(tc_worker *w)
{
    if (!w->running)
        return;
#ifdef SYS_pidfd_send_signal
    if (w->pidfd >= 0) {
        syscall(SYS_pidfd_send_signal, w->pidfd, SIGKILL, NULL, 0);
        return;
    }
#endif
    kill(w->pid, SIGKILL);
}

static void close_all(tc_worker *w)
{
    int *fd[] = {&w->socket, &w->talk, &w->pidfd};
    for (size_t i = 0; i < sizeof fd / sizeof *fd; i++) {
        if (*fd[i] >= 0)
            close(*fd[i]);
        *fd[i] = -1;
    }
    tc_wire_in_finish(&w->in);
}

/* Kills and reaps; afterwards only tc_worker_stop is left to do. */
static void put_down(tc_worker *w)
{
    int how;
    send_kill(w);
    if (w->running)
        collect_within(w, &how, 5 * LINGER_MS);
    close_all(w);
}

/* The helper closed its socket: says how it ended. detail: what was amiss with its last message, may be "". */
static tc_status fail_ended(tc_worker *w, const char *detail, tc_error *err)
{
    char line[400], limit[200] = "", cause[160];
    int how = 0;
    ending e = collect_within(w, &how, LINGER_MS);
    if (e == RUNS)
        put_down(w);
    last_line(line, sizeof line, w);
    if (e == RUNS)
        snprintf(cause, sizeof cause, "closed its connection and was stopped");
    else if (e == ENDED_UNKNOWN)
        snprintf(cause, sizeof cause, "ended; how is not known, since another part of the program collected it");
    else if (WIFSIGNALED(how))
        snprintf(cause, sizeof cause, "ended with signal %d (%s%s)", WTERMSIG(how), strsignal(WTERMSIG(how)),
                 WTERMSIG(how) == SIGKILL ? "; perhaps the system's memory ran out" : "");
    else
        snprintf(cause, sizeof cause, "ended with exit code %d", WEXITSTATUS(how));
    if (w->limits.memory_bytes > 0)
        snprintf(limit, sizeof limit, " under its memory limit of %.0f MiB%s", (double)w->limits.memory_bytes / 1048576,
                 w->machine ? " (7/8 of the machine's; if that is too little, use a machine with more)" : "");
    close_all(w);
    return tc_fail(err, TC_E_WORKER, "%s %s%s before it gave a result%s%s%s%s%s", w->name, cause, limit,
                   *detail ? " (" : "", detail, *detail ? ")" : "", *line ? ": " : "", line);
}

static tc_status fail_broken(tc_worker *w, const char *what, tc_error *err)
{
    put_down(w);
    return tc_fail(err, TC_E_WORKER, "%s broke the protocol and was stopped: %s", w->name, what);
}

void tc_worker_stop(tc_worker **worker)
{
    int how;
    tc_worker *w = worker ? *worker : NULL;
    if (!w)
        return;
    if (w->socket >= 0)
        close(w->socket);
    w->socket = -1;
    if (w->running && collect_within(w, &how, LINGER_MS) == RUNS)
        put_down(w);
    close_all(w);
    free(w->name);
    free(w);
    *worker = NULL;
}

/* ------------------------------------------------------------------------------------------------------- calling */

typedef struct call {
    tc_worker *worker;
    tc_wire_out request;
    const tc_log *log;
    tc_reply *reply;
    tc_error *err;
    bool over;
} call;

/* Takes one complete message; call->over when it was the last one. */
static tc_status take(call *c)
{
    tc_worker *w = c->worker;
    tc_reply message;
    tc_error why = {0};
    tc_status status = tc_wire_open(&message, &w->in, &why);
    if (status == TC_E_MEMORY) {
        put_down(w);
        return tc_fail(c->err, status, "%s: %s", w->name, why.text);
    }
    if (status != TC_OK)
        return fail_broken(w, why.text, c->err);
    if (message.peak_bytes > w->peak_bytes)
        w->peak_bytes = message.peak_bytes;
    for (size_t seen = atomic_load(&peak_of_all); message.peak_bytes > seen;)
        if (atomic_compare_exchange_weak(&peak_of_all, &seen, message.peak_bytes))
            break;
    const char *kind = json_string_value(json_object_get(message.json, "reply"));
    const char *text = json_string_value(json_object_get(message.json, "text"));
    const char *what = json_string_value(json_object_get(message.json, "what"));
    kind = kind ? kind : "";
    if (strcmp(kind, "result") == 0) {
        message.peak_bytes = w->peak_bytes;
        *c->reply = message;
        c->over = true;
        return TC_OK;
    }
    if (strcmp(kind, "error") == 0 && text) {
        c->over = true;
        status = tc_fail(c->err, TC_E_FILE, "%s", text);
    } else if (strcmp(kind, "progress") == 0 && what) {
        tc_progress(c->log, what, json_number_value(json_object_get(message.json, "fraction")));
    } else if (strcmp(kind, "say") == 0 && text) {
        json_int_t level = json_integer_value(json_object_get(message.json, "level"));
        tc_say(c->log, level <= 0 ? TC_WARNING : level == 1 ? TC_INFO : TC_DEBUG, "%s", text);
    } else {
        status = fail_broken(w, "a message is neither result, error, progress nor talk", c->err);
    }
    tc_reply_finish(&message);
    return status;
}

/* Milliseconds until the nearer limit (negative: over), and in *total whether that is the limit of the whole call. */
static double time_left(const tc_worker_limits *limits, double began, double heard, bool *total)
{
    double now = tc_now_ms(), left = 1e9;
    *total = false;
    if (limits->idle_s > 0)
        left = heard + limits->idle_s * 1e3 - now;
    if (limits->total_s > 0 && began + limits->total_s * 1e3 - now < left) {
        left = began + limits->total_s * 1e3 - now;
        *total = true;
    }
    return left;
}

static tc_status fail_late(tc_worker *w, bool total, tc_error *err)
{
    char line[400];
    put_down(w);
    last_line(line, sizeof line, w);
    if (total)
        return tc_fail(err, TC_E_WORKER, "%s was not done after %g s and was stopped%s%s", w->name, w->limits.total_s,
                       *line ? "; its last words: " : "", line);
    return tc_fail(err, TC_E_WORKER, "%s made no progress for %g s and was stopped%s%s", w->name, w->limits.idle_s,
                   *line ? "; its last words: " : "", line);
}

/* Sends and receives what is possible now, at most one message. */
static tc_status exchange(call *c, bool *heard)
{
    tc_worker *w = c->worker;
    tc_error why = {0};
    tc_wire_state state;
    drain(w);
    if (c->request.sent < c->request.size) {
        state = tc_wire_send(&c->request, w->socket, MSG_DONTWAIT, &why);
        if (state == TC_WIRE_BROKEN)
            return fail_broken(w, why.text, c->err);
    }
    state = tc_wire_receive(&w->in, w->socket, MSG_DONTWAIT, &why);
    if (state == TC_WIRE_CLOSED)
        return fail_ended(w, why.text, c->err);
    if (state == TC_WIRE_BROKEN)
        return fail_broken(w, why.text, c->err);
    *heard = state == TC_WIRE_DONE;
    return *heard ? take(c) : TC_OK;
}

tc_status tc_worker_call(tc_reply *out, tc_worker *worker, json_t *request, const tc_array *array, size_t n_array,
                         const tc_log *log, tc_error *err)
{
    *out = (tc_reply){0};
    if (worker->socket < 0)
        return tc_fail(err, TC_E_WORKER, "%s has ended and serves no more requests", worker->name);
    call c = {.worker = worker, .log = log, .reply = out, .err = err};
    tc_status status = tc_wire_pack(&c.request, request, array, n_array, err);
    double began = tc_now_ms(), last = began;
    while (status == TC_OK && !c.over) {
        bool total, heard = false;
        double left = time_left(&worker->limits, began, last, &total);
        if (left <= 0) {
            status = fail_late(worker, total, err);
            break;
        }
        status = exchange(&c, &heard);
        if (heard) {
            last = tc_now_ms(); /* after the log's functions, which may have taken their time */
            continue;
        }
        if (status != TC_OK)
            break;
        short more = c.request.sent < c.request.size ? POLLOUT : 0;
        struct pollfd p[2] = {{.fd = worker->socket, .events = (short)(POLLIN | more)},
                              {.fd = worker->talk, .events = POLLIN}};
        poll(p, 2, left > 6e4 ? 60000 : (int)left + 1);
    }
    tc_wire_out_finish(&c.request);
    return status;
}
