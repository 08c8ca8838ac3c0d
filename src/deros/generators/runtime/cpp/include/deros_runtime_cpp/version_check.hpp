// Copyright and licence: see package.xml.

/// \file
/// Compares the version that a package was built with and the version of the loaded library.

#ifndef DEROS_RUNTIME_CPP__VERSION_CHECK_HPP_
#define DEROS_RUNTIME_CPP__VERSION_CHECK_HPP_

#include "deros_runtime_cpp/version.h"
#include "rclcpp/node_options.hpp"

namespace deros_runtime_cpp
{

/// Return the options of a node, unless its package was built with another version of this library.
/**
 * The signature never changes, so that any version of the library can be asked.
 *
 * \param package the package of the node
 * \param version DEROS_RUNTIME_CPP_VERSION_STR, as the package was compiled with it
 * \throw Refusal if the versions differ
 */
const rclcpp::NodeOptions & checked_version(
  const rclcpp::NodeOptions & options, const char * package, const char * version);

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__VERSION_CHECK_HPP_
