/* The impact of a file of problems.py, where the equations stand, for ODE solvers in C; how its
 * time is taken, and how the tolerance is chosen. In a header, so that it can be inlined */
#ifndef VCOR_BENCHMARK_PROBLEM_H
#define VCOR_BENCHMARK_PROBLEM_H
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { most_modes = 400, batches = 15 };

/* Largest error of cor that counts as solved */
static const double wanted = 1e-8;

/* Rates beyond which explicit steps are hopeless */
static const double stiff = 1e3;

/* Laws of the modulus in the plate parameter */
enum law { law_sum, law_cerf, law_power };

struct problem {
   char name[64];
   double reference, plate, parameter[3], constant;
   enum law law;
   int n;
   double rate[most_modes], modulus[most_modes];
   bool root; /* square root of time as the independent variable */
};

static void check(bool good, const char *what)
{
   if (good) return;
   fprintf(stderr, "benchmark: %s\n", what);
   exit(EXIT_FAILURE);
}

/* u = s^1.5, continued oddly */
static inline double hertz(double s) { return s * sqrt(fabs(s)); }

/* g(tau) in a(tau) = A/sqrt(g), and its rate where one is wanted */
static inline double kernel(const struct problem *p, double tau, double *slope)
{
   const double *c = p->parameter;
   double g, rate = 0;
   switch (p->law) {
   case law_cerf: {
      const double x = c[2] * sqrt(tau), y = exp(x * x) * erfc(x);
      g = c[0] + c[1] * y;
      if (slope) rate = c[1] * c[2] * (c[2] * y - 1 / sqrt(acos(-1.0) * tau));
      break;
   }
   case law_power: {
      const double y = c[1] * (c[2] == 0.5 ? 1 / sqrt(tau) : pow(tau, -c[2]));
      g = c[0] + y;
      if (slope) rate = -c[2] * y / tau;
      break;
   }
   default:
      g = p->constant;
      for (int k = 0; k < p->n; k++) {
         const double e = p->modulus[k] * exp(-p->rate[k] * tau);
         g += e;
         rate -= p->rate[k] * e;
      }
   }
   if (slope) *slope = rate;
   return g;
}

/* a(tau): zero where the modulus is infinite */
static inline double plate(const struct problem *p, double tau)
{
   if (p->law == law_power && tau <= 0) return 0;
   return p->plate / sqrt(kernel(p, tau, NULL));
}

/* Time of a value of the independent variable, and its derivative */
static inline double time_of(const struct problem *p, double x, double *factor)
{
   *factor = p->root ? 2 * x : 1;
   return p->root ? x * x : x;
}

/* Unknowns: i, j, q_1 ... q_n */
static inline double indentation(const struct problem *p, double tau, const double *y)
{
   return tau - y[1] - plate(p, tau) * y[0];
}

static inline double force(const struct problem *p, double v, const double *q)
{
   double f = p->constant * v;
#pragma omp simd reduction(+ : f)
   for (int k = 0; k < p->n; k++) f += p->modulus[k] * (v - q[k]);
   return f;
}

/* dy/dx */
static inline void derivative(const struct problem *p, double x, const double *restrict y,
                              double *restrict d)
{
   double factor;
   const double tau = time_of(p, x, &factor), v = hertz(indentation(p, tau, y));
   d[0] = factor * force(p, v, y + 2);
   d[1] = factor * y[0];
#pragma omp simd
   for (int k = 0; k < p->n; k++) d[2 + k] = factor * p->rate[k] * (v - y[2 + k]);
}

/* The force whose zero is the end */
static inline double force_at(const struct problem *p, double x, const double *y)
{
   double factor;
   const double tau = time_of(p, x, &factor);
   return force(p, hertz(indentation(p, tau, y)), y + 2);
}

/* cor at the end of contact */
static inline double cor_at(const struct problem *p, double x, const double *y)
{
   double factor, slope;
   const double tau = time_of(p, x, &factor), g = kernel(p, tau, &slope);
   return y[0] * (1 - plate(p, tau) * slope / (2 * g)) - 1;
}

static void read_problem(struct problem *p, const char *path)
{
   char law[16];
   FILE *file = fopen(path, "r");
   check(file, "cannot read the problem");
   check(fscanf(file, "%63s %lf %lf %15s %lf %lf %lf %lf %d", p->name, &p->reference, &p->plate,
                law, &p->parameter[0], &p->parameter[1], &p->parameter[2], &p->constant,
                &p->n) == 9 && p->n <= most_modes, "not a problem");
   p->law = !strcmp(law, "cerf") ? law_cerf : !strcmp(law, "power") ? law_power : law_sum;
   for (int k = 0; k < p->n; k++)
      check(fscanf(file, "%lf %lf", &p->rate[k], &p->modulus[k]) == 2, "modes are missing");
   fclose(file);
}

/* One impact with the tolerance that was set: cor, or NaN where there is no end */
typedef double (*solver)(void *self);

static double seconds(void)
{
   struct timespec now;
   clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
   return now.tv_sec + 1e-9 * now.tv_nsec;
}

static int ascending(const void *a, const void *b)
{
   const double x = *(const double *)a, y = *(const double *)b;
   return (x > y) - (x < y);
}

/* Median of the time per impact [us], and the median deviation from it over it */
static double timed(solver solve, void *self, double *spread)
{
   double time[batches];
   int repeats = 1;
   for (;; repeats *= 2) {
      const double start = seconds();
      for (int i = 0; i < repeats; i++) solve(self);
      if (seconds() - start > 0.02) break;
   }
   for (int batch = 0; batch < batches; batch++) {
      const double start = seconds();
      for (int i = 0; i < repeats; i++) solve(self);
      time[batch] = 1e6 * (seconds() - start) / repeats;
   }
   qsort(time, batches, sizeof time[0], ascending);
   const double median = time[batches / 2];
   for (int batch = 0; batch < batches; batch++) time[batch] = fabs(time[batch] - median);
   qsort(time, batches, sizeof time[0], ascending);
   *spread = time[batches / 2] / median;
   return median;
}

/* The loosest tolerance, in quarters of a decade, that keeps the error of cor below `wanted` and
 * goes on doing so at the next two, so that no lucky crossing of zero counts; 0 if there is none */
static double loosest(solver solve, void *self, void (*set)(void *self, double tolerance),
                      double reference, double *error)
{
   enum { ladder = 33, confirmed = 3 };
   int good = 0;
   double first = 0;
   for (int i = 0; i < ladder; i++) {
      const double tolerance = pow(10.0, -5 - 0.25 * i);
      set(self, tolerance);
      const double e = fabs(solve(self) - reference);
      if (!(e <= wanted)) {
         good = 0;
         continue;
      }
      if (good++ == 0) {
         first = tolerance;
         *error = e;
      }
      if (good == confirmed) {
         set(self, first);
         return first;
      }
   }
   return 0;
}

/* A line of the table, as compare.sh reads it */
static void print_line(const struct problem *p, const char *who, const char *settings, double error,
                       double time, double spread, long steps)
{
   printf("%s,%s,%s,%.1e,%.1f,%.3f,%ld\n", p->name, who, settings, error, time, spread, steps);
}

#endif
