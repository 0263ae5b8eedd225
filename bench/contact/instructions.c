/* Instructions of a step by valgrind, which counts those of a run of so many steps and of one of
 * more. One thread. */
#include "bench/contact/contact.h"

#include "bench/instructions.h"
#include "bench/program.h"

#include <limits.h>
#include <stdio.h>

/* A sheet of 900 vertices in free fall from its pins, in five blocks: nothing can touch. */
#define SHEET                                                                                      \
    "--quiet --threads 1 --grain 200 --set 'obstacles=[]' --set 'cloths[0].mesh.grid.nx=30' "      \
    "--set 'cloths[0].mesh.grid.ny=30'"
#define NO_TOUCH "--set 'contact={mode: certified, self: off}'"

static int count(unsigned steps, bool contact, double *number)
{
    char command[3 * PATH_MAX], folder[PATH_MAX];
    program_folder(folder, sizeof folder);
    snprintf(command, sizeof command, "'%s/../duite-cloth' '%s/sheet.yaml' --end %g %s %s", folder,
             BENCH_SCENES, 0.001 * steps, SHEET, contact ? NO_TOUCH : "");
    return instructions_count(command, number);
}

/* contact=0: the scene has no map `contact`; contact=1: it has one. */
static int instructions(void *context, struct serve_request *request, double *value)
{
    const unsigned first = 4, more = (unsigned)serve_number(request, "steps");
    const bool contact = serve_number(request, "contact") != 0;
    double few, many;
    (void)context;
    int code = count(first, contact, &few);
    if (!code)
        code = count(first + more, contact, &many);
    if (!code)
        *value = (many - few) / more;
    return code;
}

const struct serve_run contact_instruction_runs[] = {{"instructions", instructions}, {0}};
