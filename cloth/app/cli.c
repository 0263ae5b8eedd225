/* argp reads the line; a value is read where its row says. */
#include "cloth/app/cli.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

struct cli_call {
    const struct cli *cli;
    char *to;
};

bool cli_above_0(const char *text, double *number)
{
    char *end = NULL;
    *number = strtod(text, &end);
    return end != text && !*end && *number > 0 && isfinite(*number);
}

static void cli_take(const struct cli_option *option, char *text, char *to,
                     struct argp_state *state)
{
    bool right = true;
    switch (option->kind) {
    case CLI_FLAG:
        *(bool *)(to + option->to) = true;
        break;
    case CLI_FILE:
        if (!*text)
            argp_error(state, "--%s takes the name of a file", option->name);
        *(char **)(to + option->to) = text;
        break;
    case CLI_ABOVE_0:
        right = cli_above_0(text, (double *)(to + option->to));
        break;
    case CLI_OTHER:
        right = option->read(text, to, state);
    }
    if (!right)
        argp_error(state, "--%s takes %s, not `%s'", option->name, option->takes, text);
}

static error_t cli_parse(int key, char *text, struct argp_state *state)
{
    const struct cli_call *call = state->input;
    const struct cli *cli = call->cli;
    for (size_t i = 0; i < cli->n_options; i++)
        if (cli->option[i].key == key) {
            cli_take(cli->option + i, text, call->to, state);
            if (cli->marks != CLI_NONE)
                *(unsigned *)(call->to + cli->marks) |= cli->option[i].marks;
            return 0;
        }
    if (key == ARGP_KEY_ARG) {
        char **argument = cli->argument == CLI_NONE ? NULL : (char **)(call->to + cli->argument);
        if (!argument || *argument)
            argp_error(state, "%s: `%s' is one too many", cli->one, text);
        *argument = text;
        return 0;
    }
    if (key != ARGP_KEY_END)
        return ARGP_ERR_UNKNOWN;
    cli->finish(call->to, state);
    return 0;
}

void cli_read(const struct cli *cli, int argc, char **argv, void *to)
{
    struct argp_option options[cli->n_options + 1];
    const struct argp argp = {options, cli_parse, cli->arguments, cli->about, NULL, NULL, NULL};
    struct cli_call call = {cli, to};
    memset(options, 0, sizeof options);
    for (size_t i = 0; i < cli->n_options; i++) {
        const struct cli_option *option = cli->option + i;
        options[i] =
            (struct argp_option){option->name, option->key, option->value, 0, option->help, 0};
    }
    argp_err_exit_status = 2;
    argp_parse(&argp, argc, argv, 0, NULL, &call);
}

char *cli_beside(const char *output, const char *ending)
{
    const size_t n = strlen(output);
    const int stem = (int)(n > 4 && strcmp(output + n - 4, ".obj") == 0 ? n - 4 : n);
    char *path = NULL;
    return asprintf(&path, "%.*s%s", stem, output, ending) < 0 ? NULL : path;
}

int cli_end(const char *program, struct cloth_error *error)
{
    if (!error->code && (fflush(stdout) != 0 || ferror(stdout)))
        cloth_fail(error, CLOTH_E_IO, "cannot write to standard output: %s", strerror(errno));
    if (error->code)
        fprintf(stderr, "%s: %s\n", program, error->text);
    return error->code ? error->code == CLOTH_E_INPUT ? 2 : 1 : 0;
}
