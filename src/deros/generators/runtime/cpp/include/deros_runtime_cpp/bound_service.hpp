// Copyright and licence: see package.xml.

#ifndef DEROS_RUNTIME_CPP__BOUND_SERVICE_HPP_
#define DEROS_RUNTIME_CPP__BOUND_SERVICE_HPP_

#include <functional>
#include <string>

namespace deros_runtime_cpp
{

/// A service that an action calls.
class BoundService
{
public:
  /// Takes a fault of the service; an empty text if there is none.
  using ReportFault = std::function<void (const std::string &)>;

  /// Takes the name of the service that has answered success.
  using ReportSuccess = std::function<void (const std::string &)>;

  virtual ~BoundService() = default;

  /// Set whom to report to; to be called before anything else.
  virtual void attach(ReportFault report_fault, ReportSuccess report_success) = 0;

  /// Call the service for a trigger of the action, or do not call it any more.
  virtual void set_active(bool active) = 0;

  /// Call again if need be, and report what is wrong; to be called every 0.1 s.
  virtual void check() = 0;
};

}  // namespace deros_runtime_cpp

#endif  // DEROS_RUNTIME_CPP__BOUND_SERVICE_HPP_
