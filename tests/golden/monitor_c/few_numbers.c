/* action stop; input v = topic /battery.cell_voltage entity e { r: v.min() < 3; } if e.r then { stop; }; */

static bool are_numbers_float32(const float *values, size_t count)
{
  /* 10 lines of numbers */
}

static double least_float32(const float *values, size_t count)
{
  /* 2 lines of numbers */
  /* 8 lines of numbers */
}
