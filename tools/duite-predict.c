/* The command line of duite-predict. */
#include "tools/command.h"
#include "tools/predict/predict.h"

#include <duite.h>

#include <config.h>

#include <argp.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { FAILED = 1, BAD_INPUT = 2 };
enum {
    BALANCE = 256,
    BANDWIDTH,
    BODIES,
    CORES,
    CORE_SPEED,
    HOSTS,
    LATENCY,
    LOOK,
    MAPPING,
    MESSAGE,
    OVERHEAD,
    PACKED,
    PAJE,
    PLATFORM,
    SCHEDULER,
    SEED,
    STEADY,
    SWITCH
};

const char *argp_program_version = "duite-predict (" PACKAGE_STRING ")";

struct command {
    const char *file, *paje, *scheduler, *mapping, *balance;
    const char *platform_file, *flat; /* flat: an option for hosts that are alike */
    struct predict_platform platform;
    struct predict_cluster cluster;
};

static const struct argp_option OPTIONS[] = {
    {"hosts", HOSTS, "N", 0, "hosts, each a rank (default: the ranks of the trace)", 1},
    {"cores", CORES, "N", 0, "cores of a host (default: the threads of the trace)", 1},
    {"core-speed", CORE_SPEED, "X", 0, "how fast a core is, against the traced one (default: 1)",
     1},
    {"latency", LATENCY, "SECONDS", 0, "of a message (default: as rank 0 measured it, else 5e-6)",
     1},
    {"bandwidth", BANDWIDTH, "BYTES/S", 0, "of a network card (default: 1.25e9, 10 Gbit/s)", 1},
    {"switch", SWITCH, "BYTES/S", 0, "of all messages together (default: enough)", 1},
    {"platform", PLATFORM, "FILE", 0,
     "hosts of several kinds and the switches between them: lines of a file", 1},
    {"message", MESSAGE, "SECONDS", 0,
     "of a core, to send or to take a message (default: as in a trace of several ranks, else 5e-7)",
     1},
    {"look", LOOK, "SECONDS", 0,
     "of a core, to look for messages between two tasks (default: as in a trace of several ranks, "
     "else as --message, at most 5e-7)",
     1},
    {"overhead", OVERHEAD, "SECONDS", 0, "between two tasks (default: as it was traced)", 1},
    {"bodies", BODIES, "FACTOR", 0, "times as long as in the trace: of larger blocks (default: 1)",
     1},
    {"packed", PACKED, NULL, 0,
     "in replays blocks send what their hints say at most: for a trace of one rank whose program "
     "packs what other ranks read",
     1},
    {"steady", STEADY, NULL, 0,
     "bodies take the median of their kernel, without what the traced machine did meanwhile", 1},
    {"scheduler", SCHEDULER, "NAME", 0, "as of duite-cloth (default: steal)", 2},
    {"mapping", MAPPING, "NAME", 0,
     "as of duite-cloth (default: the homes of the trace, if there are as many hosts as ranks; "
     "else "
     "metis)",
     2},
    {"balance", BALANCE, "NAME", 0, "as of duite-cloth: none or migrate (default: none)", 2},
    {"seed", SEED, "N", 0, "of what is random in the policies (default: 1)", 2},
    {"paje", PAJE, "OUT", 0, "write the predicted run as a Paje trace", 3},
    {0}};

static double option_number(struct argp_state *state, const char *option, const char *text)
{
    char *end;
    errno = 0;
    double value = strtod(text, &end);
    if (end == text || *end || errno || !isfinite(value) || value < 0)
        argp_error(state, "--%s %s: a number >= 0 is expected", option, text);
    return value;
}

static uint64_t option_whole(struct argp_state *state, const char *option, const char *text,
                             uint64_t least, uint64_t max)
{
    char *end;
    errno = 0;
    uint64_t value = strtoull(text, &end, 10);
    if (*text < '0' || *text > '9' || *end || errno || value < least || value > max)
        argp_error(state, "--%s %s: a whole number from %llu to %llu is expected", option, text,
                   (unsigned long long)least, (unsigned long long)max);
    return value;
}

static error_t option_policy(struct argp_state *state, int key, const char *value)
{
    struct command *command = state->input;
    struct predict_cluster *cluster = &command->cluster;
    const char *option = "scheduler", **name = &command->scheduler;
    bool found = true;
    if (key == SCHEDULER) {
        found = (cluster->scheduler = duite_scheduler_find(value));
    } else if (key == MAPPING) {
        option = "mapping", name = &command->mapping;
        found = (cluster->mapping = duite_mapping_find(value));
    } else {
        option = "balance", name = &command->balance;
        found = (cluster->balance = duite_balancer_find(value));
    }
    if (!found)
        argp_error(state, "--%s %s: %s", option, value, duite_message());
    *name = value;
    return 0;
}

/* Hosts that are alike. False: another option. */
static bool option_flat(int key, char *value, struct argp_state *state)
{
    struct command *command = state->input;
    struct predict_cluster *cluster = &command->cluster;
    const char *option = NULL;
    switch (key) {
    case HOSTS:
        cluster->hosts = (uint32_t)option_whole(state, option = "hosts", value, 1, 1 << 20);
        break;
    case CORES:
        cluster->cores =
            (uint32_t)option_whole(state, option = "cores", value, 1, DUITE_MAX_THREADS);
        break;
    case CORE_SPEED:
        cluster->core_speed = option_number(state, option = "core-speed", value);
        break;
    case LATENCY:
        cluster->latency = option_number(state, option = "latency", value);
        break;
    case BANDWIDTH:
        cluster->bandwidth = option_number(state, option = "bandwidth", value);
        break;
    case SWITCH:
        cluster->capacity = option_number(state, option = "switch", value);
        break;
    default:
        return false;
    }
    command->flat = option;
    return true;
}

static error_t option_read(int key, char *value, struct argp_state *state)
{
    struct command *command = state->input;
    struct predict_cluster *cluster = &command->cluster;
    if (option_flat(key, value, state))
        return 0;
    switch (key) {
    case PLATFORM:
        command->platform_file = value;
        return 0;
    case BODIES:
        cluster->bodies = option_number(state, "bodies", value);
        return 0;
    case MESSAGE:
        cluster->message = option_number(state, "message", value);
        return 0;
    case LOOK:
        cluster->look = option_number(state, "look", value);
        return 0;
    case OVERHEAD:
        cluster->overhead = option_number(state, "overhead", value);
        return 0;
    case SCHEDULER:
    case MAPPING:
    case BALANCE:
        return option_policy(state, key, value);
    case SEED:
        cluster->seed = option_whole(state, "seed", value, 0, UINT64_MAX);
        return 0;
    case PACKED:
        cluster->packed = true;
        return 0;
    case STEADY:
        cluster->steady = true;
        return 0;
    case PAJE:
        command->paje = value;
        return 0;
    case ARGP_KEY_END:
        if (command->platform_file && command->flat)
            argp_error(state, "--platform says what the hosts and the network are: leave out --%s",
                       command->flat);
        return 0;
    default:
        return predict_trace_argument(key, value, state, &command->file);
    }
}

static const struct argp ARGP = {
    .options = OPTIONS,
    .parser = option_read,
    .args_doc = "TRACE",
    .doc = "Says what the run of a trace (duite-cloth --trace) would take on another cluster: the "
           "main program is run again in virtual time, with the same policies.\v"
           "Exit codes: 0 done, 1 a file could not be written, 2 the trace or the command line is "
           "wrong."};

static int command_complete(struct command *command, const struct trace_run *run)
{
    struct predict_cluster *cluster = &command->cluster;
    const struct trace_header *header = run->rank[0].header;
    if (command->platform_file) {
        if (predict_platform_read(&command->platform, command->platform_file, header->workers)) {
            fprintf(stderr, "duite-predict: %s\n", duite_message());
            return BAD_INPUT;
        }
        cluster->platform = &command->platform;
        cluster->hosts = command->platform.n_hosts;
    }
    if (!cluster->hosts)
        cluster->hosts = run->n_ranks;
    if (!cluster->cores)
        cluster->cores = header->workers;
    if (cluster->latency < 0)
        cluster->latency = header->latency > 0 ? header->latency : 5e-6;
    if (!cluster->mapping && cluster->hosts != run->n_ranks) {
        cluster->mapping = duite_mapping_find("metis");
        command->mapping = "metis";
    }
    return 0;
}

static double share_of(double a, double b)
{
    return b > 0 ? a / b : 0;
}

/* The kernels with most seconds on the chain, of those with a hundredth of the makespan. */
static void kernels_print(const struct trace_run *run, double makespan, double *chain)
{
    enum { MOST = 5 };
    const char *comma = "";
    printf("  in bodies of  ");
    for (int i = 0; i < MOST; i++) {
        uint32_t most = 0;
        for (uint32_t k = 1; k < run->n_kernels; k++)
            most = chain[k] > chain[most] ? k : most;
        if (!run->n_kernels || chain[most] < 0.01 * makespan)
            break;
        printf("%s %s %.1f %%", comma, run->kernel_name[most],
               100 * share_of(chain[most], makespan));
        chain[most] = 0;
        comma = ",";
    }
    printf("%s\n", *comma ? "" : " none");
}

static void cluster_print(const struct command *command, double workers)
{
    const struct predict_cluster *c = &command->cluster;
    if (c->platform) {
        printf("  cluster        %u hosts, %.0f cores: %s", c->hosts, workers,
               command->platform_file);
        return;
    }
    printf("  cluster        %u hosts x %u cores, latency %g s, bandwidth %g bytes/s", c->hosts,
           c->cores, c->latency, c->bandwidth);
    if (isfinite(c->capacity))
        printf(", switch %g bytes/s", c->capacity);
}

static void result_print(const struct command *command, const struct predict_result *r)
{
    const struct predict_cluster *c = &command->cluster;
    const double workers =
        c->platform ? predict_platform_cores(c->platform) : (double)c->hosts * c->cores;
    const double path = fmax(r->critical_path, r->work / workers);
    cluster_print(command, workers);
    printf("\n  policies       scheduler %s, mapping %s, balance %s\n", command->scheduler,
           command->mapping, command->balance);
    printf("  tasks          %llu, stolen %llu\n", (unsigned long long)r->tasks,
           (unsigned long long)r->stolen);
    printf("  makespan       %.6f s\n", r->makespan);
    printf("  speed-up       %.3f, efficiency %.3f\n", share_of(r->work, r->makespan),
           share_of(r->work, r->makespan * workers));
    printf("  idle           %.1f %%\n", 100 * r->idle);
    printf("  messages       %llu, %llu bytes\n", (unsigned long long)r->messages,
           (unsigned long long)r->bytes);
    if (r->migrated)
        printf("  migrated       %llu objects\n", (unsigned long long)r->migrated);
    printf("  lower bound    %.6f s: critical path %.6f s, work %.6f s over %.0f cores\n", path,
           r->critical_path, r->work, workers);
    printf("  overhead       %.3g us between two tasks\n", 1e6 * r->overhead);
    if (c->hosts > 1)
        printf("  of a core      %.3g us to send or take a message, %.3g us to look for one\n",
               1e6 * r->message, 1e6 * r->look);
    printf("  limited by     %s\n", predict_limit_name(r->limit));
    printf("  held up by    ");
    for (int i = 0; i < PREDICT_LIMITS; i++)
        printf(" %s %.1f %%%s", predict_limit_name((enum predict_limit)i),
               100 * share_of(r->chain[i], r->makespan), i + 1 < PREDICT_LIMITS ? "," : "\n");
}

/* Traces of a quiet machine had 0.99 to 1.05 times count times median; from 1.3 times on the
 * predictions for 256 cores were too long by half, and more. */
static const double DISTURBED = 1.25;

static void disturbance_warn(const struct command *command, const struct predict_result *r)
{
    if (command->cluster.steady || !(r->bodies > DISTURBED * r->medians))
        return;
    fprintf(stderr,
            "duite-predict: warning: %s: bodies took %.3g s, and %.3g s had each taken the median "
            "of its kernel: something else ran on the traced machine, or tasks of a kernel differ; "
            "--steady predicts with the medians\n",
            command->file, r->bodies, r->medians);
}

static int output_failed(const char *file)
{
    fprintf(stderr, "duite-predict: %s cannot be written: %s\n", file, strerror(errno));
    return FAILED;
}

static int command_run(struct command *command, const struct trace_run *run)
{
    struct predict_result result;
    struct predict_more more = {
        .paje = command->paje ? fopen(command->paje, "w") : NULL,
        .chain = calloc(run->n_kernels + 1u, sizeof(double)),
    };
    int code = command_complete(command, run);
    if (!code && command->paje && !more.paje)
        code = output_failed(command->paje);
    if (!code && !more.chain) {
        fprintf(stderr, "duite-predict: out of memory\n");
        code = FAILED;
    }
    if (!code && predict(run, &command->cluster, &result, &more)) {
        fprintf(stderr, "duite-predict: %s: %s\n", command->file, duite_message());
        code = BAD_INPUT;
    }
    if (more.paje && (ferror(more.paje) | fclose(more.paje)) && !code)
        code = output_failed(command->paje);
    if (!code) {
        disturbance_warn(command, &result);
        result_print(command, &result);
        kernels_print(run, result.makespan, more.chain);
    }
    if (!code && (fflush(stdout) || ferror(stdout)))
        code = output_failed("standard output");
    predict_platform_free(&command->platform);
    free(more.chain);
    return code;
}

int main(int argc, char **argv)
{
    struct command command = {
        .scheduler = "steal",
        .mapping = "of the trace",
        .balance = "none",
        .cluster = predict_cluster_default(),
    };
    argp_err_exit_status = BAD_INPUT;
    if (argp_parse(&ARGP, argc, argv, 0, NULL, &command))
        return BAD_INPUT;
    struct trace_run *run;
    if (trace_read(&run, command.file, false)) {
        fprintf(stderr, "duite-predict: %s\n", duite_message());
        return BAD_INPUT;
    }
    int code = command_run(&command, run);
    trace_run_free(run);
    return code;
}
