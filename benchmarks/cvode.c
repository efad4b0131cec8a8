/* The impact as an ODE for CVODE of SUNDIALS, as well as we know how to put it.
 *
 *    cvode PROBLEM.txt [--all]
 *
 * PROBLEM.txt comes from problems.py, where the equations stand. Every way below gets the loosest
 * tolerance that does, see common/problem.h, and is timed. The fastest is printed, with --all each
 * of them, as
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
#include "problem.h"
#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>
#include <sunnonlinsol/sunnonlinsol_newton.h>

/* Ways to solve the nonlinear systems of the implicit formulas */
enum iteration { fixed_point, newton_dense, newton_arrow };

/* A way to have the ODE solved */
struct way {
   int formulas; /* CV_ADAMS or CV_BDF */
   enum iteration iteration;
   bool root;     /* square root of time as the independent variable */
   bool weighted; /* tolerances scaled by the moduli */
};

/* The problem, and what CVODE's functions need between calls */
struct impact {
   struct problem problem;
   struct way way;
   void *cvode;
   double gamma, inverse[most_modes]; /* 1/(1 + gamma r_k) of the last linear system */
   double stiffness;                  /* g0 + sum_k g_k/(1 + gamma r_k) */
   N_Vector unknowns, tolerances;
   SUNMatrix matrix;
   SUNLinearSolver linear;
   SUNNonlinearSolver nonlinear;
};

static int right_side(double x, N_Vector unknowns, N_Vector rates, void *data)
{
   const struct impact *self = data;
   derivative(&self->problem, x, NV_DATA_S(unknowns), NV_DATA_S(rates));
   return 0;
}

static int root_function(double x, N_Vector unknowns, double *g, void *data)
{
   const struct impact *self = data;
   g[0] = force_at(&self->problem, x, NV_DATA_S(unknowns));
   return 0;
}

static int jacobian(double x, N_Vector unknowns, N_Vector rates, SUNMatrix matrix, void *data,
                    N_Vector work1, N_Vector work2, N_Vector work3)
{
   const struct problem *p = &((struct impact *)data)->problem;
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
   struct impact *self = solver->content;
   const struct problem *p = &self->problem;
   N_Vector predicted, unknowns, rates, history;
   void *data;
   double x, gamma, plain, scale, factor;
   (void)matrix, (void)tolerance;
   if (CVodeGetNonlinearSystemData(self->cvode, &x, &predicted, &unknowns, &rates, &plain, &scale,
                                   &history, &data))
      return -1;
   const double tau = time_of(p, x, &factor), a = plate(p, tau);
   const double *y = NV_DATA_S(unknowns), *b = NV_DATA_S(right);
   double *z = NV_DATA_S(solution), sum = 0;
   gamma = plain * factor;
   if (gamma != self->gamma) {
      double stiffness = p->constant;
#pragma omp simd reduction(+ : stiffness)
      for (int k = 0; k < p->n; k++) {
         self->inverse[k] = 1 / (1 + gamma * p->rate[k]);
         stiffness += p->modulus[k] * self->inverse[k];
      }
      self->gamma = gamma;
      self->stiffness = stiffness;
   }
   const double slope = 1.5 * sqrt(fabs(tau - y[1] - a * y[0]));
   const double c = gamma * slope * self->stiffness;
#pragma omp simd reduction(+ : sum)
   for (int k = 0; k < p->n; k++) sum += p->modulus[k] * self->inverse[k] * b[2 + k];
   const double z0 = (b[0] - gamma * sum - c * b[1]) / (1 + c * (a + gamma));
   const double z1 = b[1] + gamma * z0, w = -gamma * slope * (a * z0 + z1);
#pragma omp simd
   for (int k = 0; k < p->n; k++) z[2 + k] = self->inverse[k] * (b[2 + k] + w * p->rate[k]);
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

static void open_way(struct impact *self, struct way way, SUNContext context)
{
   const int size = self->problem.n + 2;
   int falling = -1;
   self->way = way;
   self->problem.root = way.root;
   self->gamma = -1;
   self->unknowns = N_VNew_Serial(size, context);
   self->tolerances = N_VNew_Serial(size, context);
   self->matrix = NULL;
   self->linear = NULL;
   self->nonlinear = NULL;
   N_VConst(0.0, self->unknowns);
   self->cvode = CVodeCreate(way.formulas, context);
   check(self->cvode && !CVodeInit(self->cvode, right_side, 0.0, self->unknowns), "no CVODE");
   CVodeSetUserData(self->cvode, self);
   CVodeSetMaxNumSteps(self->cvode, 1000000);
   CVodeRootInit(self->cvode, 1, root_function);
   CVodeSetRootDirection(self->cvode, &falling);
   if (way.iteration == fixed_point) {
      self->nonlinear = SUNNonlinSol_FixedPoint(self->unknowns, 0, context);
      CVodeSetNonlinearSolver(self->cvode, self->nonlinear);
   } else if (way.iteration == newton_dense) {
      self->matrix = SUNDenseMatrix(size, size, context);
      self->linear = SUNLinSol_Dense(self->unknowns, self->matrix, context);
      check(!CVodeSetLinearSolver(self->cvode, self->linear, self->matrix), "no dense solver");
      CVodeSetJacFn(self->cvode, jacobian);
   } else {
      self->linear = SUNLinSolNewEmpty(context);
      self->linear->content = self;
      self->linear->ops->gettype = arrow_type;
      self->linear->ops->solve = solve_arrow;
      self->linear->ops->free = free_arrow;
      check(!CVodeSetLinearSolver(self->cvode, self->linear, NULL), "no embedded solver");
   }
}

static void close_way(struct impact *self)
{
   CVodeFree(&self->cvode);
   if (self->linear) SUNLinSolFree(self->linear);
   if (self->matrix) SUNMatDestroy(self->matrix);
   if (self->nonlinear) SUNNonlinSolFree(self->nonlinear);
   N_VDestroy(self->unknowns);
   N_VDestroy(self->tolerances);
}

static void set_tolerance(void *data, double tolerance)
{
   struct impact *self = data;
   double *each = NV_DATA_S(self->tolerances);
   if (!self->way.weighted) {
      CVodeSStolerances(self->cvode, tolerance, tolerance);
      return;
   }
   each[0] = each[1] = tolerance;
   for (int k = 0; k < self->problem.n; k++)
      each[2 + k] = tolerance / (1 + 10 * self->problem.modulus[k]);
   CVodeSVtolerances(self->cvode, 0.0, self->tolerances);
}

static double solve(void *data)
{
   struct impact *self = data;
   double x;
   N_VConst(0.0, self->unknowns);
   CVodeReInit(self->cvode, 0.0, self->unknowns);
   if (CVode(self->cvode, 100.0, self->unknowns, &x, CV_NORMAL) != CV_ROOT_RETURN) return NAN;
   return cor_at(&self->problem, x, NV_DATA_S(self->unknowns));
}

/* What became of one way */
struct result {
   char settings[160];
   double error, time, spread;
   long steps;
};

static bool try_way(struct impact *self, struct way way, SUNContext context, struct result *result)
{
   static const char *iterations[] = {"fixed point", "Newton dense", "Newton arrow"};
   open_way(self, way, context);
   const double tolerance =
      loosest(solve, self, set_tolerance, self->problem.reference, &result->error);
   if (tolerance > 0) {
      result->time = timed(solve, self, &result->spread);
      CVodeGetNumSteps(self->cvode, &result->steps);
      snprintf(result->settings, sizeof result->settings, "%s %s in %s tol %.1e%s",
               way.formulas == CV_ADAMS ? "Adams" : "BDF", iterations[way.iteration],
               way.root ? "sqrt(t)" : "t", tolerance, way.weighted ? " weighted" : "");
   }
   close_way(self);
   return tolerance > 0;
}

int main(int count, char **arguments)
{
   static struct impact impact;
   const struct problem *p = &impact.problem;
   SUNContext context;
   check(count >= 2, "usage: cvode PROBLEM.txt [--all]");
   const bool all = count > 2 && !strcmp(arguments[2], "--all");
   read_problem(&impact.problem, arguments[1]);
   check(!SUNContext_Create(NULL, &context), "no context");

   struct result best = {.time = INFINITY};
   for (int index = 0; index < 24; index++) {
      const struct way way = {.formulas = index & 1 ? CV_BDF : CV_ADAMS,
                              .root = index & 2,
                              .weighted = index & 4,
                              .iteration = (enum iteration)(index >> 3)};
      /* a fixed-point iteration cannot have steps longer than the shortest time of the material */
      if (way.iteration == fixed_point && p->rate[p->n - 1] > stiff) continue;
      struct result result;
      if (!try_way(&impact, way, context, &result)) continue;
      if (all)
         print_line(p, "cvode", result.settings, result.error, result.time, result.spread,
                    result.steps);
      if (result.time < best.time) best = result;
   }
   check(best.time < INFINITY, "no way leads to the accuracy");
   if (!all)
      print_line(p, "cvode", best.settings, best.error, best.time, best.spread, best.steps);
   SUNContext_Free(&context);
   return EXIT_SUCCESS;
}
