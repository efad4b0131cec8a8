/* COR and contact time of a case file at three velocities */
#include <stdio.h>
#include <vcor.h>

int main(void)
{
   const char *addresses[] = {"impact.velocity"};
   const char *columns[] = {"cor", "contact_time"};
   double velocities[] = {2.5, 5.0, 10.0}, results[3][2];
   vcor_case *drop;
   vcor_error error;

   if (vcor_read(NULL, "sls.nml", &drop, &error) == VCOR_OK) {
      vcor_set(drop, "solver.accuracy", "1e-9", &error);
      if (error.code == VCOR_OK)
         vcor_solve(drop, 1, addresses, 3, velocities, 2, columns, results[0], 0, &error);
      vcor_free(drop);
   }
   if (error.code != VCOR_OK) {
      fprintf(stderr, "%s\n", error.message);
      return error.code;
   }
   for (int i = 0; i < 3; i++)
      printf("%4.1f m/s: COR %.8f, contact %.3e s\n", velocities[i], results[i][0], results[i][1]);
   return 0;
}
