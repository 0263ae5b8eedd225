/* The time on the cores is that of /proc/stat: user, nice, system, interrupts, and what a host took
 * away (steal). */
#include "tools/compare/load.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

static const double MOST_TAKEN = 0.25; /* of the cores */

static double now(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

static double busy(void)
{
    double user, nice, system, idle, wait, irq, softirq, steal;
    FILE *file = fopen("/proc/stat", "r");
    const int n = file ? fscanf(file, "cpu %lf %lf %lf %lf %lf %lf %lf %lf", &user, &nice, &system,
                                &idle, &wait, &irq, &softirq, &steal)
                       : 0;
    if (file)
        fclose(file);
    return n == 8 ? (user + nice + system + irq + softirq + steal) / (double)sysconf(_SC_CLK_TCK)
                  : NAN;
}

static double seconds_of(int who)
{
    struct rusage usage;
    if (getrusage(who, &usage))
        return NAN;
    return (double)(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
           1e-6 * (double)(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

static double own(void)
{
    return seconds_of(RUSAGE_SELF) + seconds_of(RUSAGE_CHILDREN);
}

void load_begin(struct load *load)
{
    *load = (struct load){
        .cores = (double)sysconf(_SC_NPROCESSORS_ONLN), .busy = busy(), .own = own(), .at = now()};
    if (getloadavg(&load->average, 1) != 1)
        load->average = NAN;
}

double load_others(const struct load *load)
{
    const double seconds = now() - load->at;
    const double taken = busy() - load->busy - (own() - load->own);
    return seconds < 0.5 ? NAN : fmax(taken, 0 * taken) / seconds; /* 0 * NAN is NAN */
}

const char *load_warn_average(double average, double cores, char *text, size_t size)
{
    if (!(average > MOST_TAKEN * cores))
        return NULL;
    snprintf(text, size,
             "the load average is %.2f on %g cores before the first run: the machine is busy, and "
             "its figures mislead",
             average, cores);
    return text;
}

const char *load_warn_others(double others, double cores, char *text, size_t size)
{
    if (!(others > MOST_TAKEN * cores))
        return NULL;
    snprintf(text, size, "other programs took %.2f of %g cores: the figures mislead", others,
             cores);
    return text;
}
