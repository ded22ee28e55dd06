/* settings.c: the options of a picture as words of a command line. */
#define _GNU_SOURCE
#include "window/settings.h"
#include "cli/edit_command.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Of `edit` and of files that this window does not write. */
static bool is_aside(const char *option)
{
    static const char *const aside[] = {"--paraview", "--output",     "--stats",   "--error-image", "--verify",
                                        "--repeat",   "--count",      "--audit",   "--trace",       "--gl",
                                        "--error",    "--frame-time", "--no-cache"};
    for (size_t i = 0; i < sizeof aside / sizeof *aside; i++)
        if (!strcmp(option, aside[i]))
            return true;
    return false;
}

void tc_settings_destroy(tc_settings **settings)
{
    tc_settings *s = *settings;
    if (!s)
        return;
    tc_render_command_finish(&s->options);
    for (size_t i = 0; i < s->n; i++)
        free(s->word[i]);
    free(s->word);
    free(s);
    *settings = NULL;
}

/* Takes the word, from malloc; NULL: memory is out. */
static bool add(tc_settings *s, char *word)
{
    char **more = word ? realloc(s->word, (s->n + 2) * sizeof *more) : NULL;
    if (!more) {
        free(word);
        return false;
    }
    s->word = more;
    s->word[s->n++] = word;
    s->word[s->n] = NULL;
    return true;
}

static char *option_word(const char *name, const char *text, bool flag)
{
    char *word = NULL;
    if (!text || (flag && !strcmp(text, "on")))
        return strdup(name);
    return asprintf(&word, "%s=%s", name, text) < 0 ? NULL : word;
}

/* Does a word give this option? */
static bool gives(const char *word, const char *name)
{
    const size_t length = strlen(name);
    return !strncmp(word, name, length) && (!word[length] || word[length] == '=');
}

/* Reads the words that are there. */
static int take(tc_settings *s, tc_talk *talk, const tc_command *command)
{
    tc_edit_command values = {0};
    const int code = tc_picture_command_read(&values.render, talk, command, (int)s->n, s->word);
    s->options = values.render;
    return code;
}

static int out_of_memory(tc_settings **out, tc_settings **made, tc_talk *talk)
{
    tc_talk_error(talk, "memory ran out");
    tc_settings_destroy(made);
    *out = NULL;
    return TC_EXIT_FAILED;
}

/* The words' options, or nothing of it. */
static int settle(tc_settings **out, tc_settings **made, tc_talk *talk, const tc_command *command)
{
    const int code = take(*made, talk, command);
    if (code >= 0)
        tc_settings_destroy(made);
    *out = *made;
    return code;
}

int tc_settings_read(tc_settings **out, const char **trace, tc_talk *talk, const tc_command *command, int argc,
                     char **argv)
{
    tc_edit_command values = {0};
    *out = NULL;
    int code = tc_picture_command_read(&values.render, talk, command, argc, argv);
    if (trace)
        *trace = values.trace;
    tc_settings *s = code < 0 ? calloc(1, sizeof *s) : NULL;
    bool good = s && add(s, strdup("edit"));
    if (good) {
        char *whole = tc_input_is_synthetic(values.render.input) ? NULL : realpath(values.render.input, NULL);
        good = add(s, whole ? whole : strdup(values.render.input));
    }
    for (size_t i = 0; good && i < values.render.given.n; i++) {
        const tc_given *one = &values.render.given.item[i];
        if (!is_aside(one->option->name))
            good = add(s, option_word(one->option->name, one->text, one->option->kind == TC_OPTION_FLAG));
    }
    tc_render_command_finish(&values.render);
    if (code >= 0)
        return code;
    return good ? settle(out, &s, talk, command) : out_of_memory(out, &s, talk);
}

int tc_settings_change(tc_settings **out, const tc_settings *settings, const char *const (*change)[2], size_t n,
                       tc_talk *talk, const tc_command *command)
{
    tc_settings *s = calloc(1, sizeof *s);
    bool good = s != NULL;
    for (size_t i = 0; good && i < settings->n; i++) {
        bool stays = true;
        for (size_t k = 0; k < n; k++)
            stays = stays && (i < 2 || !gives(settings->word[i], change[k][0]));
        if (stays)
            good = add(s, strdup(settings->word[i]));
    }
    for (size_t k = 0; good && k < n; k++) {
        const tc_option *option = tc_command_option(command, change[k][0]);
        const bool flag = option && option->kind == TC_OPTION_FLAG, many = option && option->repeat;
        const char *text = change[k][1], *end;
        for (bool more = text != NULL; good && more; text = end + 1) {
            end = many ? strchrnul(text, '\n') : text + strlen(text);
            more = *end != 0;
            char *line = strndup(text, (size_t)(end - text));
            good = line && add(s, option_word(change[k][0], line, flag));
            free(line);
        }
    }
    return good ? settle(out, &s, talk, command) : out_of_memory(out, &s, talk);
}

int tc_settings_with(tc_settings **out, const tc_settings *settings, const char *option, const char *text,
                     tc_talk *talk, const tc_command *command)
{
    const char *const change[1][2] = {{option, text}};
    return tc_settings_change(out, settings, change, 1, talk, command);
}

const char *tc_settings_text(const tc_settings *settings, const char *option)
{
    const tc_given_list *given = &settings->options.given;
    for (size_t i = given->n; i-- > 0;)
        if (!strcmp(given->item[i].option->name, option))
            return given->item[i].text ? given->item[i].text : "";
    return NULL;
}

char *tc_settings_command(const tc_settings *settings)
{
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=:,./@%";
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    if (!stream)
        return NULL;
    fputs("tetcast render", stream);
    for (size_t i = 1; i < settings->n; i++) {
        const char *word = settings->word[i];
        fputc(' ', stream);
        if (strspn(word, plain) == strlen(word)) {
            fputs(word, stream);
            continue;
        }
        fputc('\'', stream);
        for (; *word; word++)
            fputs(*word == '\'' ? "'\\''" : (const char[]){*word, 0}, stream);
        fputc('\'', stream);
    }
    if (fclose(stream) != 0) {
        free(text);
        return NULL;
    }
    return text;
}
