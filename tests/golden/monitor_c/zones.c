/* action stop; input p = topic /odom.pose.pose.position zone yard = polygon (0, 0) (4, 0) (4, 3) (2.5, 1.5) (0, 3) m "where it drives" zone pit = circle (1, -0.5) 25 cm zone dock = rectangle (3, 0) (4, 1) m entity e { r: not p.inside(yard) or p.inside(pit) or p.inside(dock); } if e.r then { stop; }; */

/* p.inside(yard) as 1 or 0; zone yard, declared in line 2: where it drives */
static double compute_1_yard(double p_x, double p_y)
{
  const double side_3_4 = (-1.5 * (p_y - 3.0)) + (1.5 * (p_x - 4.0));
  const double side_2_4 = (-1.5 * p_y) - (1.5 * (p_x - 4.0));
  const double side_4_5 = (-2.5 * (p_y - 1.5)) - (1.5 * (p_x - 2.5));
  return ((!is_number(p_x)) || (!is_number(p_y))) ? NAN : ((((p_x <= 4.0) && (side_3_4 >= 0.0)
    && (side_2_4 <= 0.0)) || ((side_4_5 >= 0.0) && (p_x >= 0.0) && (p_y >= 0.0)
    && (side_2_4 >= 0.0))) ? 1.0 : 0.0);
}

static double compute_2_pit(double p_x, double p_y)
{
  const double from_x = p_x - 0.01;
  const double from_y = p_y + 0.005;
  return ((!is_number(p_x)) || (!is_number(p_y))) ? NAN : ((((from_x * from_x) + (from_y
    * from_y)) <= 0.0625) ? 1.0 : 0.0);
}

static double compute_3_dock(double p_x, double p_y)
{
  return ((!is_number(p_x)) || (!is_number(p_y))) ? NAN : (((p_x >= 3.0) && (p_x <= 4.0)
    && (p_y >= 0.0) && (p_y <= 1.0)) ? 1.0 : 0.0);
}
