/* vcor: coefficient of restitution of viscoelastic spheres and plates, from C.
 *
 * A case is made from its text or its file, its values are set by address (as --set of the program
 * takes them), and then it is solved: once, or for n points of some of its values. All numbers are
 * in SI units and the same bits as those of the program.
 *
 * Errors. Every function that can fail returns one of the codes below, and puts code and message
 * into `error`, which may be NULL. The message is the line that the program prints. Nothing is
 * printed, nothing ends the process. A pointer that is NULL where this page does not allow it, and a
 * number of elements below zero, are VCOR_ERROR_USAGE; the message names the argument. An array without
 * elements may be NULL. A time or a frequency that is NaN is VCOR_ERROR_INPUT; a value that is NaN makes
 * its point VCOR_INVALID. No function can detect
 * a pointer that vcor_read() has not made, or one to memory that has been released: what follows is
 * undefined.
 *
 * Memory. What a function hands over as a pointer (a text, an array) is released with free(), a case
 * with vcor_free(). Where the memory is too small, the code is VCOR_ERROR_FILE.
 *
 * Threads. All functions may be called from several threads at once, for the same case too; texts
 * are read and checked by one thread at a time, impacts are solved side by side. A library that was
 * built without OpenMP (CMake: VCOR_OPENMP=OFF) has no lock and may be called from one thread only.
 * After fork() the child may call everything if no other thread of the parent was in a call; a child
 * of a process that has solved on several threads solves on one, since the threads are not copied.
 */
#ifndef VCOR_H
#define VCOR_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Codes: those of the program at its exit */
enum {
   VCOR_OK = 0,
   VCOR_ERROR_INTERNAL = 1,  /* a fault of the library */
   VCOR_ERROR_USAGE = 2,     /* an address or a name does not exist, a value cannot be read */
   VCOR_ERROR_INPUT = 3,     /* the case or a data file is wrong */
   VCOR_ERROR_FILE = 4,      /* a file cannot be read */
   VCOR_ERROR_NUMERICAL = 5  /* no result to be trusted */
};

/* Values of the column `status` */
enum {
   VCOR_SEPARATED = 0,      /* the force returned to zero: the normal end */
   VCOR_NO_SEPARATION = 1,  /* end_time came first */
   VCOR_STICKS = 2,         /* all motion decayed in contact */
   VCOR_INVALID = 3,        /* the values of the point make no impact */
   VCOR_FAILED = 4,         /* the numerical solution failed */
   VCOR_RESTS = 5           /* its weight keeps the sphere in contact for good */
};

/* Tables that vcor_column describes */
enum {
   VCOR_SUMMARY = 0,  /* one row per impact */
   VCOR_HISTORY = 1,  /* one row per time */
   VCOR_COMPARED = 2, /* quantities that vcor_verify compares */
   VCOR_BOUNCES = 3   /* one row per bounce */
};

typedef struct vcor_case vcor_case;

typedef struct {
   int code;            /* one of VCOR_OK, VCOR_ERROR_... */
   char message[2048];  /* one line, empty if there is nothing to say */
} vcor_error;

typedef struct {
   char name[256];     /* an address that is longer is refused */
   char symbol[16];
   char unit[32];      /* "1" for a pure number, empty for a text */
   char meaning[128];
   char labels[512];   /* words that the numbers of the column stand for, blanks between them; or empty */
   int first;          /* number of the first word */
   int is_whole;       /* whether its numbers are whole */
} vcor_column;

/* Version of the library */
const char *vcor_library_version(void);

/* A case from `text`, or from the file `name` if `text` is NULL. `name`, which is not NULL, stands in
 * messages, and data files that the case names are relative to its folder. What the case says is checked when it is
 * used, so that vcor_set can complete it. On failure *self is NULL, which all functions refuse. */
int vcor_read(const char *text, const char *name, vcor_case **self, vcor_error *error);

/* Release a case; NULL is allowed */
void vcor_free(vcor_case *self);

/* Another case of the same values, which gives the same bits and the same messages. It keeps the mesh of
 * vcor_settle. On failure *copy is NULL. */
int vcor_copy(const vcor_case *self, vcor_case **copy, vcor_error *error);

/* The case as a text for another process, with all that was set, the folder of its data files and their check
 * sums. The text is for vcor_load alone, of the same version. A mesh of vcor_settle is not in it. */
int vcor_dump(const vcor_case *self, char **text, vcor_error *error);

/* The case of a text of vcor_dump, wherever the process is. A text of another version or a damaged one, and
 * data files that have changed since, are VCOR_ERROR_INPUT, one that cannot be read is VCOR_ERROR_FILE. On
 * failure *self is NULL. */
int vcor_load(const char *text, vcor_case **self, vcor_error *error);

/* Name of the case: that of its file, or the one that vcor_read was given for a text */
int vcor_name(const vcor_case *self, char **name, vcor_error *error);

/* Complete a case by the groups of another one, which has &material groups alone, as `vcor run` takes
 * files of materials after a case. Data files that these groups name stay relative to the folder of
 * `materials`, which may be released afterwards. */
int vcor_add_materials(vcor_case *self, const vcor_case *materials, vcor_error *error);

/* Put the one &material group of `text` in the place of that of this name. Data files that it names are
 * relative to the folder of `source`, a file for messages, or to that of the case if `source` is NULL. */
int vcor_replace_material(vcor_case *self, const char *material, const char *text, const char *source,
                          vcor_error *error);

/* Remove the &sweep groups, so that the case is a single impact */
int vcor_remove_sweeps(vcor_case *self, vcor_error *error);

/* Set the value at an address such as "impact.velocity", "rubber.beta" or "rubber.moduli(2)"; the
 * value as a namelist has it, a text also without quotes. Of two keys for one quantity, such as velocity and
 * drop_height, the one that was set last counts and the other one is no longer given. */
int vcor_set(vcor_case *self, const char *address, const char *value, vcor_error *error);

/* Remove the value at an address, so that its default holds; or, by its name, all values of a group that occurs
 * once, such as "target", or a material. A name of both is refused: in quotes, "'target'", it is the material. */
int vcor_unset(vcor_case *self, const char *address, vcor_error *error);

/* Value at an address as a namelist has it, given or by default, a list of one number with a comma after it;
 * `*value` is NULL if there is none */
int vcor_get(const vcor_case *self, const char *address, char **value, vcor_error *error);

/* Path, unit and meaning of an address */
int vcor_describe(const vcor_case *self, const char *address, vcor_column *column,
                  vcor_error *error);

/* Groups and keys of cases: a JSON array in UTF-8, the member "groups" of what `vcor help --json` prints, with
 * meaning, unit, range, choices and default of each key */
int vcor_catalogue(char **text, vcor_error *error);

/* The case as namelists; with `complete` also every default. The case is checked first. */
int vcor_case_text(const vcor_case *self, int complete, char **text,
                   vcor_error *error);

/* Write the case to the file `path`, as vcor_case_text has it. Data files keep their place: if the file is in
 * another folder, they stand there by their absolute paths. */
int vcor_save(const vcor_case *self, const char *path, int complete, vcor_error *error);

/* Column `index`, from 0, of a table; returns 0 if there is none or `column` is NULL, 1 otherwise */
int vcor_column_of(int table, int index, vcor_column *column);

/* Parameter `index`, from 0, that the &sweep groups of the case vary, slowest first: its address is
 * column->name, and it has `*n` values. `*values` is NULL if there is none of this index. */
int vcor_axis(const vcor_case *self, int index, vcor_column *column, int *n, double **values,
              vcor_error *error);

/* Keep the mesh that suits the case as it is now for all that is solved from it later, until vcor_set
 * changes a number of &solver. On one mesh results follow the parameters steadily, as differences of
 * neighbours need it; the error of a point far away may be larger than it states. Only waves = 'body' and method
 * 'coupled' have a mesh to keep. */
int vcor_settle(vcor_case *self, vcor_error *error);

/* Solve n points, in each of which m addresses have values of their own.
 *
 *   values   n rows of m numbers: values[i*m + j] at addresses[j] in point i
 *   columns  names of k columns of the summary
 *   results  n rows of k numbers, nan where there is none; `status` and other texts by their number
 *   threads  threads to use, at most 1024; 0: as many as there are cores
 *
 * With m = 0 and n = 1 the case itself is solved, and an impact without a result is an error. With
 * m > 0 such a point has a status, and error->message says what the matter is, with the number of
 * the first such point counted from 1, while the code is VCOR_OK. One call for many points takes half
 * as long as a call for each. vcor_set of a text, a list or a switch checks the whole case anew, vcor_set of a
 * number that was set before does not. If
 * the case has &sweep groups, their addresses must be among those that are given. */
int vcor_solve(vcor_case *self, int m, const char *const *addresses, int n, const double *values,
               int k, const char *const *columns, double *results, int threads, vcor_error *error);

/* Solve one impact, in which m addresses have values of their own, and say what there is to say about it: for
 * loops. With m = 0 it is that of the case itself. An impact without a result is an error, whose message says why;
 * its status is among the results nevertheless.
 *
 *   values       m numbers
 *   results      k numbers, those of the columns
 *   units        numbers that look like those in another unit, as vcor_warnings has them, also on failure
 *   validity     a line, if a measure of validity is not good
 *   beyond_data  what the data of the materials do not cover, as vcor_beyond_data has it. Up to four impacts more
 *                are solved for it, but only if the contact is shorter or longer than those before it of the same
 *                values but for velocity and drop height; else it is what is said of the shortest and the longest
 *
 * The last three are texts, `*units` and so on NULL if there is nothing to say; each may be NULL where nobody asks. */
int vcor_impact(vcor_case *self, int m, const char *const *addresses, const double *values, int k,
                const char *const *columns, double *results, char **units, char **validity,
                char **beyond_data, vcor_error *error);

/* Numbers that look like those in another unit, such as a radius of 15 m: a line for each, of the case and
 * of the values of n points, which are those of vcor_solve. Each is given once for a case and its later copies. A
 * single point (n = 1), or the case as it is (m = 0), is looked at again only when other addresses have values.
 * `*text` is NULL if there is nothing new. */
int vcor_warnings(vcor_case *self, int m, const char *const *addresses, int n, const double *values,
                  char **text, vcor_error *error);

/* What the data behind the materials do not say about n points that vcor_solve has solved: contacts that
 * begin before the data of a fit (valid_from, valid_to) or of a table, or last longer, with the change of cor
 * that depends on it, and temperatures outside of those of a shift. `statuses`, `contact_times` and `cors`
 * are the columns status, contact_time and cor of the points. A line for each remark; `*text` is empty if the
 * data say all that matters, and NULL if no material has data of a known range. Of a fit it solves up to four
 * impacts more, while other calls wait. */
int vcor_beyond_data(vcor_case *self, int m, const char *const *addresses, int n, const double *values,
                     const double *statuses, const double *contact_times, const double *cors,
                     char **text, vcor_error *error);

/* History of a single impact: `*rows` rows of the columns of VCOR_HISTORY. An impact that does not end
 * in separation has one, too. */
int vcor_history(vcor_case *self, int *rows, double **values, vcor_error *error);

/* Bounces of a single impact: `*rows` rows of the columns of VCOR_BOUNCES, none if the sphere stays where it first
 * touches, one without impact.bounces. The columns bouncing_time and bounces_end of vcor_solve say when and how they
 * ended. */
int vcor_bounces(vcor_case *self, int *rows, double **values, vcor_error *error);

/* Relaxation modulus E(t) [Pa] of a material at n times >= 0 [s] */
int vcor_relaxation(const vcor_case *self, const char *material, int n, const double *times,
                    double *moduli, vcor_error *error);

/* Storage and loss modulus [Pa] of a material at n angular frequencies >= 0 [rad/s] */
int vcor_complex_modulus(const vcor_case *self, const char *material, int n,
                         const double *frequencies, double *storage, double *loss,
                         vcor_error *error);

/* Shift factor a_T of a material at impact.temperature, 1 for one without a shift */
int vcor_time_factor(const vcor_case *self, const char *material, double *factor, vcor_error *error);

/* Shift factors a_T of a material at n temperatures > 0 [K], whatever impact.temperature is; an error where its law
 * does not hold at one of them */
int vcor_time_factors(const vcor_case *self, const char *material, int n, const double *temperatures,
                      double *factors, vcor_error *error);

/* The case by all methods: for each row of VCOR_COMPARED the most accurate value, that by internal
 * variables (nan if they cannot solve it), that by product integration extrapolated to steps of no
 * length, and the number of digits that can be trusted: 4 numbers a row, nan where the bodies do not
 * separate. Methods that contradict each other are an error. */
int vcor_verify(vcor_case *self, double *results, vcor_error *error);

/* cor_sphere of the case, a single impact, with exact mechanics; nan if it has none. It is that of the
 * case itself where that has them already. */
int vcor_exact(vcor_case *self, double *cor_sphere, vcor_error *error);

#ifdef __cplusplus
}
#endif
#endif
