// Copyright and licence: see package.xml.

// Checks of parameters: yours to fill in. deros wrote this file once and leaves it alone.

#include "mapping/checks.hpp"

… 8 lines as in checks.hpp: #include <string>
std::string small(const rclcpp::Parameter & /*parameter*/)
{
  return "must pass checks::small, which is not written yet";
}

}  // namespace checks
