/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Does every command end in its time? Runs the program on frameworks that were slow once, with
 * --time-limit 2 and with signals at random moments, and measures memory and processor time of it
 * and all its children: a busy machine does not matter. Where cores are free, several work at once:
 * then the time by the clock counts if it is less.
 *
 *   watchdog PROGRAM FOLDER [--full] [--signals N] [WORD]   WORD: only cases with it in their name;
 * FOLDER is for files
 *
 * One line per case that fails, with all its words with -v in WORD's place; closes with "N passed,
 * N failed". */
#define _GNU_SOURCE
#include "tests/watchdog/frames.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

static const double cpu_limit = 3; /* s, with --time-limit 2 */
static const double draw_limit =
    60; /* the same with drawings, which are made whole, or until 200 MB are full */
static const double plan_by =
    1.2; /* CPU s, with --time-limit 2: there is some plan after that, where others leave it .. */
static const double time_used =
    1.5; /* s: .. if it was the time that ended the search, not the size of the problem */
static const double after_signal = 1; /* s */
static const double started =
    0.05; /* s: before, a signal may meet a process that is still being loaded */
static const long memory_limit = 1L << 20; /* KiB */
enum { MOST_WORDS = 40, TICK = 10 /* ms */ };

static const char *program, *folder, *only = "";
static int passed, failed;

/* ---- running ---- */

typedef struct {
  int code; /* exit code, or - signal */
  double cpu, wall, cpu_at_signal;
  long memory; /* KiB: the largest process */
  bool sent;   /* the signal, before the end */
  char message[400];
} result;

static double now(void)
{
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Processor time so far of the process and its living descendants, and what those have waited for.
 */
static double cpu_of(pid_t pid)
{
  char path[64], line[1024];
  double sum = 0;
  snprintf(path, sizeof path, "/proc/%d/stat", (int)pid);
  FILE *in = fopen(path, "r");
  if (!in) return 0;
  char *end = fgets(line, sizeof line, in) ? strrchr(line, ')') : NULL;
  unsigned long user, system;
  long waited_user, waited_system;
  if (end && sscanf(end + 1, " %*c %*d %*d %*d %*d %*d %*u %*u %*u %*u %*u %lu %lu %ld %ld", &user,
                    &system, &waited_user, &waited_system) == 4)
    sum = (double)((long)user + (long)system + waited_user + waited_system) /
          (double)sysconf(_SC_CLK_TCK);
  fclose(in);
  snprintf(path, sizeof path, "/proc/%d/task/%d/children", (int)pid, (int)pid);
  if ((in = fopen(path, "r"))) {
    for (int child; fscanf(in, "%d", &child) == 1;)
      sum += cpu_of((pid_t)child);
    fclose(in);
  }
  return sum;
}

static double seconds(struct timeval t)
{
  return (double)t.tv_sec + 1e-6 * (double)t.tv_usec;
}

static void start(char *const argv[], const char *log)
{
  int to = open(log, O_WRONLY | O_CREAT | O_TRUNC, 0666), none = open("/dev/null", O_RDONLY);
  setpgid(0, 0);
  if (to < 0 || none < 0 || dup2(none, 0) < 0 || dup2(to, 1) < 0 || dup2(to, 2) < 0) _exit(126);
  execv(program, argv);
  _exit(127);
}

/* Children whose parent is gone are ours (subreaper): they are ended, waited for and counted. */
static void count(result *r, const struct rusage *u)
{
  r->cpu += seconds(u->ru_utime) + seconds(u->ru_stime);
  if (u->ru_maxrss > r->memory) r->memory = u->ru_maxrss;
}

static void last_line(const char *log, char *out, size_t size)
{
  FILE *in = fopen(log, "r");
  char line[400];
  out[0] = '\0';
  while (in && fgets(line, sizeof line, in))
    if (line[0] != '\n') snprintf(out, size, "%.*s", (int)strcspn(line, "\n"), line);
  if (in) fclose(in);
}

/* Runs the program; with `signal` it gets that after `delay` s. Ended by force when it has used 3 s
 * more than most. */
static result run(char *const argv[], int signal, double delay, double most)
{
  char log[1024];
  struct rusage u;
  result r = {0};
  int status;
  bool done = false;
  double began = now();
  snprintf(log, sizeof log, "%s/log.txt", folder);
  pid_t pid = fork();
  if (pid == 0) start(argv, log);
  setpgid(pid, pid);
  while (!done) {
    nanosleep(&(struct timespec){.tv_nsec = TICK * 1000000L}, NULL);
    if (signal && !r.sent && now() - began >= delay) {
      r.sent = true;
      r.cpu_at_signal = cpu_of(pid);
      kill(pid, signal);
    }
    if (cpu_of(pid) > r.cpu_at_signal + most + 3 || now() - began > 60 + 10 * most)
      kill(-pid, SIGKILL);
    pid_t ended = wait4(pid, &status, WNOHANG, &u);
    done = ended == pid || (ended < 0 && errno != EINTR);
  }
  r.wall = now() - began;
  r.code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  count(&r, &u);
  kill(-pid, SIGKILL);
  while (wait4(-1, &status, 0, &u) > 0)
    count(&r, &u);
  last_line(log, r.message, sizeof r.message);
  return r;
}

/* ---- verdicts ---- */

static void report(const char *name, const char *what, const result *r)
{
  if (what)
    failed++;
  else
    passed++;
  if (!what && strcmp(only, "-v") != 0) return;
  printf("%s  %-62s %5.2f CPU s %5.1f s %5ld MB  exit %d  %s%s%.200s\n", what ? "FAIL" : "ok  ",
         name, r->cpu, r->wall, r->memory / 1024, r->code, what ? what : "", what ? ": " : "",
         what || r->code == 5 ? r->message : "");
  fflush(stdout);
}

static bool is_there(const char *path)
{
  struct stat s;
  return stat(path, &s) == 0;
}

/* Whatever wrote plan: is it one, and does it hold? */
static const char *check(const char *plan, result *r)
{
  char *argv[] = {(char *)(size_t)program, "check", (char *)(size_t)plan, NULL};
  *r = run(argv, 0, 0, 60);
  return r->code == 0 ? NULL : "plan refused by thread check";
}

/* Of a run that may leave a plan: what is wrong, or NULL. */
static const char *judge(const result *r, const char *plan, bool interrupted, double limit)
{
  static char text[200];
  const double cpu = interrupted ? r->cpu - r->cpu_at_signal : r->cpu,
               most = interrupted ? after_signal : limit;
  const double used =
      fmin(cpu, interrupted ? cpu : r->wall); /* where cores are free, several work at once */
  bool written = plan && is_there(plan);
  if (used > most) {
    snprintf(text, sizeof text, "%.2f CPU s%s", used, interrupted ? " after the signal" : "");
    return text;
  }
  if (r->memory > memory_limit) return "more than 1 GB";
  if (r->code < 0 && interrupted && r->cpu < started && !written) return NULL;
  if (r->code != 0 && r->code != 4 && r->code != 5) return "exit code";
  bool had_time = r->code == 5 && !interrupted && r->cpu >= plan_by && r->wall >= time_used;
  if (plan && !written && (r->code == 0 || had_time)) return "no plan";
  if (r->code == 4 && written) return "exit code 4";
  if (!written && r->code != 0 && strncmp(r->message, "thread: ", 8) != 0) return "no message";
  return NULL;
}

/* ---- plans ---- */

typedef struct {
  const char *name;
  const char *word[6];
  bool selected; /* in the quick selection, beside all frames that are selected */
} request;

static const request requests[] = {
    {"length", {"--objective", "length"}, true},
    {"length-any", {"--objective", "length", "--ends", "any"}, false},
    {"length-balance", {"--objective", "length", "--ends", "any", "--balance"}, false},
    {"turning", {"--objective", "tortuosity"}, true},
    {"turning-shortest", {"--objective", "tortuosity", "--length-slack", "0%"}, false},
    {"largest", {"--objective", "tortuosity", "--minimize", "max-turning", "--ends", "any"}, false},
    {"symmetry", {"--objective", "symmetry"}, false},
    {"symmetry-any", {"--objective", "symmetry", "--ends", "any"}, true},
};
enum { N_REQUESTS = sizeof requests / sizeof *requests };

/* A symmetric plan has as many cords as there are copies; what is balanced are several. */
static bool takes_cords(const request *q, int cords)
{
  return cords > 1 ? strncmp(q->name, "symmetry", 8) != 0 : strcmp(q->name, "length-balance") != 0;
}

/* argv of `thread plan`; frame and plan are paths. */
static void plan_words(char *argv[MOST_WORDS], const char *frame, const char *plan,
                       const request *q, bool tube, int cords, const char *limit)
{
  static char number[16];
  int n = 0;
  const char *fixed[] = {program, "plan", frame, "-o", plan, "-q", "--time-limit", limit};
  snprintf(number, sizeof number, "%d", cords);
  for (size_t i = 0; i < sizeof fixed / sizeof *fixed; i++)
    argv[n++] = (char *)(size_t)fixed[i];
  for (int i = 0; i < 6 && q->word[i]; i++)
    argv[n++] = (char *)(size_t)q->word[i];
  if (tube) argv[n++] = (char *)(size_t) "--joint", argv[n++] = (char *)(size_t) "tube";
  if (cords > 1) argv[n++] = (char *)(size_t) "--cords", argv[n++] = number;
  argv[n] = NULL;
}

static void try_plan(const char *name, char *const argv[], const char *plan, int signal,
                     double delay)
{
  result r, checked;
  unlink(plan);
  r = run(argv, signal, delay, signal ? after_signal : cpu_limit);
  const char *what = judge(&r, plan, r.sent, cpu_limit);
  if (!what && is_there(plan) && (what = check(plan, &checked))) r = checked;
  report(name, what, &r);
}

/* The quick selection: of every selected frame some requests, each with another joint and number of
 * cords. */
static bool is_selected(int frame, int request_, bool tube, int cords)
{
  if (!watchdog_frame_selected(frame) || !requests[request_].selected) return false;
  int turn = (frame + request_) % 4;
  return tube == (turn % 2 == 1) &&
         (cords > 1) == (turn >= 2 && takes_cords(&requests[request_], 3));
}

static void all_plans(bool full)
{
  char frame[1024], plan[1024], name[200], *argv[MOST_WORDS];
  snprintf(plan, sizeof plan, "%s/plan.json", folder);
  for (int f = 0; f < watchdog_frames(); f++) {
    snprintf(frame, sizeof frame, "%s/%s.obj", folder, watchdog_frame_name(f));
    for (int q = 0; q < N_REQUESTS; q++)
      for (int tube = 0; tube < 2; tube++)
        for (int cords = 1; cords <= 3; cords += 2) {
          if (!takes_cords(&requests[q], cords)) continue;
          if (!full && !is_selected(f, q, tube, cords)) continue;
          snprintf(name, sizeof name, "plan %s %s %s cords-%d", watchdog_frame_name(f),
                   requests[q].name, tube ? "tube" : "solid", cords);
          if (only[0] != '-' && !strstr(name, only)) continue;
          plan_words(argv, frame, plan, &requests[q], tube, cords, "2");
          try_plan(name, argv, plan, 0, 0);
        }
  }
}

/* ---- signals ---- */

static unsigned random_state = 1;

static unsigned next_random(unsigned n)
{
  random_state = random_state * 1664525u + 1013904223u;
  return (random_state >> 8) % n;
}

static void all_signals(int count)
{
  char frame[1024], plan[1024], name[200], *argv[MOST_WORDS];
  snprintf(plan, sizeof plan, "%s/plan.json", folder);
  for (int i = 0; i < count; i++) {
    int f = (int)next_random((unsigned)watchdog_frames()), q = (int)next_random(N_REQUESTS),
        tube = (int)next_random(2);
    int cords = takes_cords(&requests[q], 3) && (next_random(2) || !takes_cords(&requests[q], 1))
                    ? 3
                    : 1,
        signal = next_random(2) ? SIGINT : SIGTERM;
    double delay = 0.02 + next_random(1000) / 1000. * next_random(1000) / 1000. * 3;
    snprintf(name, sizeof name, "signal-%d %s %s %s cords-%d after %.2f s", signal,
             watchdog_frame_name(f), requests[q].name, tube ? "tube" : "solid", cords, delay);
    if (only[0] != '-' && !strstr(name, only)) continue;
    snprintf(frame, sizeof frame, "%s/%s.obj", folder, watchdog_frame_name(f));
    plan_words(argv, frame, plan, &requests[q], tube, cords, "100");
    try_plan(name, argv, plan, signal, delay);
  }
}

/* ---- other commands ---- */

static void try_words(const char *name, const char *const word[], double limit)
{
  char *argv[MOST_WORDS];
  int n = 0;
  if (only[0] != '-' && !strstr(name, only)) return;
  argv[n++] = (char *)(size_t)program;
  for (int i = 0; word[i] && n + 1 < MOST_WORDS; i++)
    argv[n++] = (char *)(size_t)word[i];
  argv[n] = NULL;
  result r = run(argv, 0, 0, limit);
  report(name, judge(&r, NULL, false, limit), &r);
}

/* What is made of a plan, and the table of groups. */
static void other_commands(bool full)
{
  char frame[1024], plan[1024], drawn[1024], name[200];
  snprintf(plan, sizeof plan, "%s/drawn.json", folder);
  snprintf(drawn, sizeof drawn, "%s/drawn", folder);
  for (int f = 0; f < watchdog_frames(); f++) {
    if (!full && !watchdog_frame_selected(f)) continue;
    snprintf(frame, sizeof frame, "%s/%s.obj", folder, watchdog_frame_name(f));
    unlink(plan);
    snprintf(name, sizeof name, "plan-draw %s", watchdog_frame_name(f));
    try_words(name,
              (const char *[]){"plan", frame, "-o", plan, "--draw", drawn, "-q", "--time-limit",
                               "2", "--memory", "200MB", NULL},
              draw_limit);
    snprintf(name, sizeof name, "draw %s", watchdog_frame_name(f));
    if (is_there(plan))
      try_words(name,
                (const char *[]){"draw", plan, "-T", "all", "-o", drawn, "--time-limit", "2", NULL},
                cpu_limit);
    snprintf(name, sizeof name, "info %s", watchdog_frame_name(f));
    if (full || f % 3 == 2)
      try_words(name, (const char *[]){"info", frame, "--time-limit", "2", NULL}, cpu_limit);
    snprintf(name, sizeof name, "symmetries %s", watchdog_frame_name(f));
    if (full || f % 3 == 0)
      try_words(name, (const char *[]){"symmetries", frame, "--time-limit", "2", NULL}, cpu_limit);
    snprintf(name, sizeof name, "symmetries-any-tube %s", watchdog_frame_name(f));
    if (full || f % 3 == 1)
      try_words(name,
                (const char *[]){"symmetries", frame, "--ends", "any", "--joint", "tube",
                                 "--time-limit", "2", NULL},
                cpu_limit);
  }
}

/* ---- memory ---- */

/* What libraries and the two processes of a command take beside what they allocate, KiB. */
enum { BESIDE = 40 << 10 };

/* With 60 MB a plan, perhaps of a search given up, or a message; and no process is larger than
 * that. */
static void little_memory(bool full)
{
  char frame[1024], plan[1024], name[200];
  snprintf(plan, sizeof plan, "%s/little.json", folder);
  for (int f = 0; f < watchdog_frames(); f++)
    for (int tube = 0; tube < 2; tube++) {
      snprintf(name, sizeof name, "memory-60MB %s %s", watchdog_frame_name(f),
               tube ? "tube" : "solid");
      if ((!full && (!watchdog_frame_selected(f) || f % 3 != 1)) ||
          (only[0] != '-' && !strstr(name, only)))
        continue;
      snprintf(frame, sizeof frame, "%s/%s.obj", folder, watchdog_frame_name(f));
      unlink(plan);
      const char *const word[] = {program,
                                  "plan",
                                  frame,
                                  "-o",
                                  plan,
                                  "-q",
                                  "--time-limit",
                                  "2",
                                  "--memory",
                                  "60MB",
                                  "--objective",
                                  "tortuosity",
                                  "--joint",
                                  tube ? "tube" : "solid",
                                  NULL};
      result r = run((char *const *)(size_t)word, 0, 0, cpu_limit), checked;
      const char *what = judge(&r, plan, false, cpu_limit);
      if (!what && r.memory > 60000000 / 1024 + BESIDE) what = "more than 60 MB";
      if (!what && is_there(plan) && (what = check(plan, &checked))) r = checked;
      report(name, what, &r);
    }
}

/* ---- all ---- */

static bool write_frames(void)
{
  char path[1024];
  bool sound = mkdir(folder, 0777) == 0 || errno == EEXIST;
  for (int f = 0; f < watchdog_frames() && sound; f++) {
    snprintf(path, sizeof path, "%s/%s.obj", folder, watchdog_frame_name(f));
    sound = watchdog_frame_write(f, path);
  }
  if (!sound) fprintf(stderr, "watchdog: cannot write to %s\n", folder);
  return sound;
}

int main(int argc, char **argv)
{
  bool full = false;
  int signals = -1;
  if (argc < 3) {
    fprintf(stderr, "usage: watchdog PROGRAM FOLDER [--full] [--signals N] [WORD | -v]\n");
    return 2;
  }
  program = argv[1];
  folder = argv[2];
  for (int i = 3; i < argc; i++) {
    if (strcmp(argv[i], "--full") == 0)
      full = true;
    else if (strcmp(argv[i], "--signals") == 0 && i + 1 < argc)
      signals = atoi(argv[++i]);
    else
      only = argv[i];
  }
  prctl(PR_SET_CHILD_SUBREAPER, 1);
  if (!write_frames()) return 1;
  all_plans(full);
  other_commands(full);
  little_memory(full);
  all_signals(signals >= 0 ? signals : full ? 200 : 12);
  printf("%d passed, %d failed\n", passed, failed);
  return failed > 0;
}
