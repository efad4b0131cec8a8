/* The impact as an ODE for CVODE of SUNDIALS, as well as we know how to put it.
 *
 *    cvode PROBLEM.txt [--all]
 *
 * PROBLEM.txt comes from problems.py, where the equations stand. Every way below is tried with
 * falling tolerances; its tolerance is the loosest one that keeps the error of cor below `wanted`
 * and goes on doing so at the next two, so that no lucky crossing of zero counts. The ways are then
 * timed, and the fastest is printed (with --all each of them), as
 *
 *    problem,solver,settings,error,microseconds,spread,steps
 *
 * with the median of CPU times per impact over batches, and the median deviation from it over it.
 * Everything is allocated once; an impact is CVodeReInit and one call of CVode.
 *
 * What a way can be:
 *  - Adams or BDF formulas, with fixed-point iteration or Newton's;
 *  - the linear systems of Newton's method by a dense factorisation with the analytic Jacobian, or
 *    by elimination of the modes: the matrix is an arrow, and a solution takes a few operations
 *    per mode, with a Jacobian that is always the newest;
 *  - time, or its square root, as the independent variable: u = s^1.5 and alpha(t) of the
 *    fractional kernels are smooth functions of the latter only;
 *  - the same tolerance for all unknowns, or one that falls with the modulus of the mode, as errors
 *    of q_k enter the force times g_k. */
#define _POSIX_C_SOURCE 199309L
#include <cvode/cvode.h>
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>
#include <sunnonlinsol/sunnonlinsol_newton.h>
#include <time.h>

enum { most_modes = 400, batches = 15 };

/* Largest error of cor that counts as solved */
static const double wanted = 1e-8;

/* Laws of the modulus in the plate parameter */
enum law { law_sum, law_cerf, law_power };

/* Ways to solve the nonlinear systems of the implicit formulas */
enum iteration { fixed_point, newton_dense, newton_arrow };

/* A way to have the ODE solved */
struct way {
   int formulas; /* CV_ADAMS or CV_BDF */
   enum iteration iteration;
   bool root;     /* square root of time as the independent variable */
   bool weighted; /* tolerances that know the moduli */
};

/* The problem and what its functions need between calls */
struct impact {
   char name[64];
   double reference, plate, parameter[3], constant;
   enum law law;
   int n;
   double rate[most_modes], modulus[most_modes];
   struct way way;
   void *cvode;
   double gamma, inverse[most_modes]; /* 1/(1 + gamma r_k) of the last linear system */
   double stiffness;                  /* g0 + sum_k g_k/(1 + gamma r_k) */
};

static void check(bool good, const char *what)
{
   if (good) return;
   fprintf(stderr, "cvode: %s\n", what);
   exit(EXIT_FAILURE);
}

/* u = s^1.5, continued oddly */
static double hertz(double s) { return s * sqrt(fabs(s)); }

/* g(tau) in a(tau) = A/sqrt(g), and its rate where one is wanted */
static double kernel(const struct impact *p, double tau, double *slope)
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
static double plate(const struct impact *p, double tau)
{
   if (p->law == law_power && tau <= 0) return 0;
   return p->plate / sqrt(kernel(p, tau, NULL));
}

/* Time of a value of the independent variable, and its derivative */
static double time_of(const struct impact *p, double x, double *factor)
{
   *factor = p->way.root ? 2 * x : 1;
   return p->way.root ? x * x : x;
}

/* Unknowns: i, j, q_1 ... q_n */
static double indentation(const struct impact *p, double tau, const double *y)
{
   return tau - y[1] - plate(p, tau) * y[0];
}

static double force(const struct impact *p, double v, const double *q)
{
   double f = p->constant * v;
#pragma omp simd reduction(+ : f)
   for (int k = 0; k < p->n; k++) f += p->modulus[k] * (v - q[k]);
   return f;
}

static int right_side(double x, N_Vector unknowns, N_Vector rates, void *data)
{
   const struct impact *p = data;
   const double *y = NV_DATA_S(unknowns);
   double *d = NV_DATA_S(rates), factor;
   const double tau = time_of(p, x, &factor), v = hertz(indentation(p, tau, y));
   d[0] = factor * force(p, v, y + 2);
   d[1] = factor * y[0];
#pragma omp simd
   for (int k = 0; k < p->n; k++) d[2 + k] = factor * p->rate[k] * (v - y[2 + k]);
   return 0;
}

static int root_function(double x, N_Vector unknowns, double *g, void *data)
{
   const struct impact *p = data;
   double factor;
   const double *y = NV_DATA_S(unknowns), tau = time_of(p, x, &factor);
   g[0] = force(p, hertz(indentation(p, tau, y)), y + 2);
   return 0;
}

static int jacobian(double x, N_Vector unknowns, N_Vector rates, SUNMatrix matrix, void *data,
                    N_Vector work1, N_Vector work2, N_Vector work3)
{
   const struct impact *p = data;
   double factor, total = p->constant;
   const double *y = NV_DATA_S(unknowns), tau = time_of(p, x, &factor), a = plate(p, tau);
   const double slope = 1.5 * sqrt(fabs(tau - y[1] - a * y[0]));
   (void)rates, (void)work1, (void)work2, (void)work3;
   for (int k = 0; k < p->n; k++) {
      total += p->modulus[k];
      SM_ELEMENT_D(matrix, 0, 2 + k) = -factor * p->modulus[k];
      SM_ELEMENT_D(matrix, 2 + k, 0) = -factor * p->rate[k] * slope * a;
      SM_ELEMENT_D(matrix, 2 + k, 1) = -factor * p->rate[k] * slope;
      SM_ELEMENT_D(matrix, 2 + k, 2 + k) = -factor * p->rate[k];
   }
   SM_ELEMENT_D(matrix, 0, 0) = -factor * total * slope * a;
   SM_ELEMENT_D(matrix, 0, 1) = -factor * total * slope;
   SM_ELEMENT_D(matrix, 1, 0) = factor;
   return 0;
}

/* Solution of (1 - gamma Jacobian) z = b with the modes eliminated: with w the change of the
 * indentation and v' = dv/dsigma, z_k = (b_k + gamma r_k v' w)/(1 + gamma r_k) */
static int solve_arrow(SUNLinearSolver solver, SUNMatrix matrix, N_Vector solution, N_Vector right,
                       double tolerance)
{
   struct impact *p = solver->content;
   N_Vector predicted, unknowns, rates, history;
   void *data;
   double x, gamma, plain, scale, factor;
   (void)matrix, (void)tolerance;
   if (CVodeGetNonlinearSystemData(p->cvode, &x, &predicted, &unknowns, &rates, &plain, &scale,
                                   &history, &data))
      return -1;
   const double tau = time_of(p, x, &factor), a = plate(p, tau);
   const double *y = NV_DATA_S(unknowns), *b = NV_DATA_S(right);
   double *z = NV_DATA_S(solution), sum = 0;
   gamma = plain * factor;
   if (gamma != p->gamma) {
      double stiffness = p->constant;
#pragma omp simd reduction(+ : stiffness)
      for (int k = 0; k < p->n; k++) {
         p->inverse[k] = 1 / (1 + gamma * p->rate[k]);
         stiffness += p->modulus[k] * p->inverse[k];
      }
      p->gamma = gamma;
      p->stiffness = stiffness;
   }
   const double slope = 1.5 * sqrt(fabs(tau - y[1] - a * y[0])), c = gamma * slope * p->stiffness;
#pragma omp simd reduction(+ : sum)
   for (int k = 0; k < p->n; k++) sum += p->modulus[k] * p->inverse[k] * b[2 + k];
   const double z0 = (b[0] - gamma * sum - c * b[1]) / (1 + c * (a + gamma));
   const double z1 = b[1] + gamma * z0, w = -gamma * slope * (a * z0 + z1);
#pragma omp simd
   for (int k = 0; k < p->n; k++) z[2 + k] = p->inverse[k] * (b[2 + k] + w * p->rate[k]);
   z[0] = z0;
   z[1] = z1;
   return 0;
}

static SUNLinearSolver_Type arrow_type(SUNLinearSolver solver)
{
   (void)solver;
   return SUNLINEARSOLVER_MATRIX_EMBEDDED;
}

static int free_arrow(SUNLinearSolver solver)
{
   SUNLinSolFreeEmpty(solver);
   return 0;
}

/* CVODE's objects for one way */
struct session {
   N_Vector unknowns, tolerances;
   SUNMatrix matrix;
   SUNLinearSolver linear;
   SUNNonlinearSolver nonlinear;
};

static struct session open_session(struct impact *p, struct way way, SUNContext context)
{
   struct session s = {0};
   p->way = way;
   p->gamma = -1;
   s.unknowns = N_VNew_Serial(p->n + 2, context);
   s.tolerances = N_VNew_Serial(p->n + 2, context);
   N_VConst(0.0, s.unknowns);
   p->cvode = CVodeCreate(way.formulas, context);
   check(p->cvode && !CVodeInit(p->cvode, right_side, 0.0, s.unknowns), "CVodeInit failed");
   CVodeSetUserData(p->cvode, p);
   CVodeSStolerances(p->cvode, 1e-6, 1e-6);
   CVodeSetMaxNumSteps(p->cvode, 1000000);
   if (way.iteration == fixed_point) {
      s.nonlinear = SUNNonlinSol_FixedPoint(s.unknowns, 0, context);
      CVodeSetNonlinearSolver(p->cvode, s.nonlinear);
   } else if (way.iteration == newton_dense) {
      s.matrix = SUNDenseMatrix(p->n + 2, p->n + 2, context);
      s.linear = SUNLinSol_Dense(s.unknowns, s.matrix, context);
      check(!CVodeSetLinearSolver(p->cvode, s.linear, s.matrix), "no dense linear solver");
      CVodeSetJacFn(p->cvode, jacobian);
   } else {
      s.linear = SUNLinSolNewEmpty(context);
      s.linear->content = p;
      s.linear->ops->gettype = arrow_type;
      s.linear->ops->solve = solve_arrow;
      s.linear->ops->free = free_arrow;
      check(!CVodeSetLinearSolver(p->cvode, s.linear, NULL), "no embedded linear solver");
   }
   int falling = -1;
   CVodeRootInit(p->cvode, 1, root_function);
   CVodeSetRootDirection(p->cvode, &falling);
   return s;
}

static void close_session(struct impact *p, struct session *s)
{
   CVodeFree(&p->cvode);
   if (s->linear) SUNLinSolFree(s->linear);
   if (s->matrix) SUNMatDestroy(s->matrix);
   if (s->nonlinear) SUNNonlinSolFree(s->nonlinear);
   N_VDestroy(s->unknowns);
   N_VDestroy(s->tolerances);
}

static void set_tolerance(struct impact *p, struct session *s, double tolerance)
{
   double *each = NV_DATA_S(s->tolerances);
   if (!p->way.weighted) {
      CVodeSStolerances(p->cvode, tolerance, tolerance);
      return;
   }
   each[0] = each[1] = tolerance;
   for (int k = 0; k < p->n; k++) each[2 + k] = tolerance / (1 + 10 * p->modulus[k]);
   CVodeSVtolerances(p->cvode, 0.0, s->tolerances);
}

/* One impact: cor, or NaN where CVODE gives up */
static double solve(struct impact *p, struct session *s)
{
   double x, factor, slope;
   N_VConst(0.0, s->unknowns);
   CVodeReInit(p->cvode, 0.0, s->unknowns);
   if (CVode(p->cvode, 100.0, s->unknowns, &x, CV_NORMAL) != CV_ROOT_RETURN) return NAN;
   const double tau = time_of(p, x, &factor), g = kernel(p, tau, &slope);
   return NV_Ith_S(s->unknowns, 0) * (1 - plate(p, tau) * slope / (2 * g)) - 1;
}

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
static double timed(struct impact *p, struct session *s, double *spread)
{
   double time[batches];
   int repeats = 1;
   for (;; repeats *= 2) {
      const double start = seconds();
      for (int i = 0; i < repeats; i++) solve(p, s);
      if (seconds() - start > 0.02) break;
   }
   for (int batch = 0; batch < batches; batch++) {
      const double start = seconds();
      for (int i = 0; i < repeats; i++) solve(p, s);
      time[batch] = 1e6 * (seconds() - start) / repeats;
   }
   qsort(time, batches, sizeof time[0], ascending);
   const double median = time[batches / 2];
   for (int batch = 0; batch < batches; batch++) time[batch] = fabs(time[batch] - median);
   qsort(time, batches, sizeof time[0], ascending);
   *spread = time[batches / 2] / median;
   return median;
}

static void read_problem(struct impact *p, const char *path)
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

/* What became of one way */
struct result {
   char text[160];
   double error, time, spread;
   long steps;
};

static bool try_way(struct impact *p, struct way way, SUNContext context, struct result *result)
{
   enum { ladder = 33, confirmations = 2 };
   static const char *iterations[] = {"fixed point", "Newton dense", "Newton arrow"};
   struct session s = open_session(p, way, context);
   int good = 0;
   double error[ladder], tolerance = 0;
   for (int i = 0; i < ladder && good <= confirmations; i++) {
      set_tolerance(p, &s, pow(10.0, -5 - 0.25 * i));
      error[i] = fabs(solve(p, &s) - p->reference);
      good = error[i] <= wanted ? good + 1 : 0;
      if (good > confirmations) {
         tolerance = pow(10.0, -5 - 0.25 * (i - confirmations));
         result->error = error[i - confirmations];
      }
   }
   if (tolerance > 0) {
      set_tolerance(p, &s, tolerance);
      result->time = timed(p, &s, &result->spread);
      CVodeGetNumSteps(p->cvode, &result->steps);
      snprintf(result->text, sizeof result->text, "%s %s in %s tol %.1e%s",
               way.formulas == CV_ADAMS ? "Adams" : "BDF", iterations[way.iteration],
               way.root ? "sqrt(t)" : "t", tolerance, way.weighted ? " weighted" : "");
   }
   close_session(p, &s);
   return tolerance > 0;
}

int main(int count, char **arguments)
{
   static struct impact impact;
   SUNContext context;
   check(count >= 2, "usage: cvode PROBLEM.txt [--all]");
   const bool all = count > 2 && !strcmp(arguments[2], "--all");
   read_problem(&impact, arguments[1]);
   check(!SUNContext_Create(NULL, &context), "no context");

   struct result best = {.time = INFINITY};
   for (int index = 0; index < 24; index++) {
      const struct way way = {.formulas = index & 1 ? CV_BDF : CV_ADAMS,
                              .root = index & 2,
                              .weighted = index & 4,
                              .iteration = (enum iteration)(index >> 3)};
      /* a fixed-point iteration cannot have steps longer than the shortest time of the material */
      if (way.iteration == fixed_point && impact.rate[impact.n - 1] > 1e3) continue;
      struct result result = {.time = INFINITY};
      if (!try_way(&impact, way, context, &result)) continue;
      if (all)
         printf("%s,cvode,%s,%.1e,%.1f,%.3f,%ld\n", impact.name, result.text, result.error,
                result.time, result.spread, result.steps);
      if (result.time < best.time) best = result;
   }
   check(best.time < INFINITY, "no way leads to the accuracy");
   if (!all)
      printf("%s,cvode,%s,%.1e,%.1f,%.3f,%ld\n", impact.name, best.text, best.error, best.time,
             best.spread, best.steps);
   SUNContext_Free(&context);
   return EXIT_SUCCESS;
}
