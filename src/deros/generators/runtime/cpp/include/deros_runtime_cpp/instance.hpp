// Copyright and licence: see package.xml.

#ifndef DEROS_RUNTIME_CPP__INSTANCE_HPP_
#define DEROS_RUNTIME_CPP__INSTANCE_HPP_

#include <cstddef>
#include <filesystem>
#include <string>

#include "deros_runtime_cpp/descriptor.hpp"

namespace deros_runtime_cpp
{

/// Return the folder of the locks of this user's nodes.
std::filesystem::path lock_folder();

/// Hold the lock of a node, by its fully qualified name, for as long as what is returned lives.
/**
 * It ends with the process, however that ends. The locks in a folder are a user's own: those of
 * other users, and of other machines, are not known here. Nodes in Python and in C++ share them.
 * \throw Refusal if somebody else holds the lock
 * \throw std::system_error if there can be no lock
 */
Descriptor claim(
  const std::string & name, std::size_t domain,
  const std::filesystem::path & folder = lock_folder());

/// Return what tells the files of a node from those of all others.
std::string file_stem(const std::string & name, std::size_t domain);

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__INSTANCE_HPP_
