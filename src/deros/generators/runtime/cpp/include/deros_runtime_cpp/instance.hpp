// Copyright and licence: see package.xml.

#ifndef DEROS_RUNTIME_CPP__INSTANCE_HPP_
#define DEROS_RUNTIME_CPP__INSTANCE_HPP_

#include <cstddef>
#include <filesystem>
#include <string>

#include "deros_runtime_cpp/descriptor.hpp"

namespace deros_runtime_cpp
{

/// Return the folder of the locks of the nodes of this user.
std::filesystem::path lock_folder();

/// Take the single-instance lock of a node, by its fully qualified name; the result holds it.
/**
 * The lock ends with the process, however that ends. Nodes in Python and in C++ share it; other
 * users and other machines do not.
 * \throw Refusal if another process holds the lock
 * \throw std::system_error if the lock cannot be taken
 */
Descriptor claim(
  const std::string & name, std::size_t domain,
  const std::filesystem::path & folder = lock_folder());

/// Return the stem of the names of a node's files, which is unique to the node.
std::string file_stem(const std::string & name, std::size_t domain);

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__INSTANCE_HPP_
