/* What the proofs rely on of the mathematical library: that its functions return, and change
 * nothing that the program can see, and that equal arguments give equal results. Stands in for
 * <math.h> while Frama-C reads the monitor. */
#define __FC_MATH
#define NAN (0.0 / 0.0)
#define INFINITY (1.0 / 0.0)
/* Two numbers are the same if no function tells them apart, NaN and zeros included: so it is with
 * members of sets, where == would be of real numbers. */
#define same(a, b) \subset({a}, {b})
/*@ axiomatic Libm {
      predicate is_sqrt(double y, double x);
      predicate is_fmod(double z, double x, double y);
      predicate is_remainder(double z, double x, double y);
      predicate is_sin(double y, double x);
      predicate is_cos(double y, double x);
      predicate is_tan(double y, double x);
      predicate is_asin(double y, double x);
      predicate is_atan2(double z, double y, double x);
    } */
/*@ assigns \nothing; */
extern double fabs(double x);
/*@ assigns \nothing; ensures is_sqrt(\result, x); */
extern double sqrt(double x);
/*@ assigns \nothing; ensures is_sin(\result, x); */
extern double sin(double x);
/*@ assigns \nothing; ensures is_cos(\result, x); */
extern double cos(double x);
/*@ assigns \nothing; ensures is_tan(\result, x); */
extern double tan(double x);
/*@ assigns \nothing; ensures is_atan2(\result, y, x); */
extern double atan2(double y, double x);
/*@ assigns \nothing; ensures is_asin(\result, x); */
extern double asin(double x);
/*@ assigns \nothing; ensures is_remainder(\result, x, y); */
extern double remainder(double x, double y);
/*@ assigns \nothing; ensures is_fmod(\result, x, y); */
extern double fmod(double x, double y);
