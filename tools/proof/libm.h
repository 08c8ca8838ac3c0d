/* What the proofs rely on of the mathematical library: that its functions return, and change
 * nothing that the program can see. Stands in for <math.h> while Frama-C reads the monitor. */
#define __FC_MATH
#define NAN (0.0 / 0.0)
#define INFINITY (1.0 / 0.0)
/*@ assigns \nothing; */
extern double fabs(double x);
/*@ assigns \nothing; */
extern double sqrt(double x);
/*@ assigns \nothing; */
extern double atan2(double y, double x);
/*@ assigns \nothing; */
extern double asin(double x);
/*@ assigns \nothing; */
extern double fmod(double x, double y);
