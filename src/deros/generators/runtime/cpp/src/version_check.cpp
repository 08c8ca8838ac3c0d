// Copyright and licence: see package.xml.

#include "deros_runtime_cpp/version_check.hpp"

#include <string>

#include "deros_runtime_cpp/refusal.hpp"

namespace deros_runtime_cpp
{

const rclcpp::NodeOptions & checked_version(
  const rclcpp::NodeOptions & options, const char * package, const char * version)
{
  const std::string loaded = DEROS_RUNTIME_CPP_VERSION_STR;
  if (loaded != version) {
    throw Refusal(
            std::string(package) + " was built with deros_runtime_cpp " + version +
            ", but the loaded library has version " + loaded + ": build the package again");
  }
  return options;
}

}  // namespace deros_runtime_cpp
