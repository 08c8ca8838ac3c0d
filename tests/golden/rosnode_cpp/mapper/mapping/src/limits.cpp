// Copyright and licence: see package.xml.

// Checks of parameters: yours to fill in. deros wrote this file once and leaves it alone.

#include "mapping/limits.hpp"

… 8 lines as in limits.hpp: #include <string>
std::string is_even(const rclcpp::Parameter & /*parameter*/)
{
  return "must pass limits::is_even, which is not written yet";
}

}  // namespace limits
