/* The impact by an explicit Runge-Kutta method written for it, with a table of SUNDIALS' ARKODE. No
 * general-purpose solver, but what a patient user could write for a material with a few relaxation
 * times. Arguments and output are those of cvode.c.
 *
 * Nothing but vectors of a few unknowns is touched, and the end is found as vcor finds it, by the
 * length of the last step, not by interpolation. Modes with short times make the steps as short: a
 * fractional material cannot be done. */
#define _POSIX_C_SOURCE 199309L
#include "problem.h"
#include <arkode/arkode_butcher_erk.h>

enum { most_unknowns = 32, most_stages = 16 };

struct run {
   struct problem problem;
   ARKodeButcherTable table;
   double tolerance;
   long steps;
};

typedef double stages[most_stages][most_unknowns];

/* A step from y at x, where k[0] is known, to y_end */
static void step(const struct run *self, double x, double h, const double *restrict y, stages k,
                 double *restrict y_end)
{
   const ARKodeButcherTable table = self->table;
   const int n = self->problem.n + 2;
   for (int i = 1; i <= table->stages; i++) {
      const double *a = i < table->stages ? table->A[i] : table->b;
      double sum[most_unknowns];
      for (int m = 0; m < n; m++) sum[m] = 0;
      for (int j = 0; j < i; j++)
         if (a[j] != 0)
            for (int m = 0; m < n; m++) sum[m] += a[j] * k[j][m];
      for (int m = 0; m < n; m++) sum[m] = y[m] + h * sum[m];
      if (i < table->stages)
         derivative(&self->problem, x + table->c[i] * h, sum, k[i]);
      else
         memcpy(y_end, sum, n * sizeof *sum);
   }
}

/* The estimated error of a step over the tolerance */
static double excess(const struct run *self, double h, const double *y, const double *y_end,
                     stages k)
{
   const ARKodeButcherTable table = self->table;
   const int n = self->problem.n + 2;
   double sum = 0;
   for (int m = 0; m < n; m++) {
      double e = 0;
      for (int j = 0; j < table->stages; j++) e += (table->b[j] - table->d[j]) * k[j][m];
      e *= h / (self->tolerance * (1 + fmax(fabs(y[m]), fabs(y_end[m]))));
      sum += e * e;
   }
   return sqrt(sum / n);
}

static double solve(void *data)
{
   struct run *self = data;
   const struct problem *p = &self->problem;
   stages k;
   double y[most_unknowns] = {0}, end[most_unknowns], x = 0, h = 0.25;
   self->steps = 0;
   derivative(p, x, y, k[0]);
   while (self->steps < 10000) {
      step(self, x, h, y, k, end);
      self->steps++;
      const double e = excess(self, h, y, end, k);
      const double factor = fmin(5, fmax(0.3, 0.9 * pow(e + 1e-10, -1.0 / self->table->q)));
      if (!(e <= 1)) {
         h *= fmin(factor, 0.9);
         continue;
      }
      double f = force_at(p, x + h, end);
      if (f <= 0) {
         /* secant method for the length of this step */
         double other = 0, f_other = force_at(p, x, y);
         for (int i = 0; i < 20 && fabs(f) > 1e-8 && fabs(h - other) > 1e-9; i++) {
            const double next = h - f * (h - other) / (f - f_other);
            other = h;
            f_other = f;
            h = next;
            step(self, x, h, y, k, end);
            self->steps++;
            f = force_at(p, x + h, end);
         }
         return cor_at(p, x + h, end);
      }
      x += h;
      memcpy(y, end, sizeof y);
      derivative(p, x, y, k[0]);
      h *= factor;
   }
   return NAN;
}

static void set_tolerance(void *data, double tolerance)
{
   ((struct run *)data)->tolerance = tolerance;
}

int main(int count, char **arguments)
{
   static struct run run;
   static const int tables[] = {ARKODE_VERNER_8_5_6, ARKODE_FEHLBERG_13_7_8};
   struct problem *p = &run.problem;
   char text[80], best_text[80];
   double best = INFINITY, best_error = 0, best_spread = 0;
   long best_steps = 0;
   check(count >= 2, "usage: runge_kutta PROBLEM.txt [--all]");
   const bool all = count > 2 && !strcmp(arguments[2], "--all");
   read_problem(p, arguments[1]);
   check(p->n + 2 <= most_unknowns && p->rate[p->n - 1] < stiff, "too stiff for explicit steps");

   for (int index = 0; index < 4; index++) {
      double error = 0, spread;
      p->root = index & 1;
      run.table = ARKodeButcherTable_LoadERK(tables[index >> 1]);
      check(run.table && run.table->stages <= most_stages, "no table");
      const double tolerance = loosest(solve, &run, set_tolerance, p->reference, &error);
      if (tolerance > 0) {
         const double time = timed(solve, &run, &spread);
         snprintf(text, sizeof text, "order %d in %s tol %.1e", run.table->q,
                  p->root ? "sqrt(t)" : "t", tolerance);
         if (all) print_line(p, "runge_kutta", text, error, time, spread, run.steps);
         if (time < best) {
            best = time;
            best_error = error;
            best_spread = spread;
            best_steps = run.steps;
            strcpy(best_text, text);
         }
      }
      ARKodeButcherTable_Free(run.table);
   }
   check(best < INFINITY, "no table leads to the accuracy");
   if (!all) print_line(p, "runge_kutta", best_text, best_error, best, best_spread, best_steps);
   return EXIT_SUCCESS;
}
