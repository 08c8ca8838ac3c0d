// Copyright and licence: see package.xml.

// The actions of every_thing_safety_node: yours to fill in.
// deros wrote this file once and leaves it alone.

#ifndef EVERY_THING_SAFETY_CPP__EVERY_THING_SAFETY_NODE_ACTIONS_HPP_
#define EVERY_THING_SAFETY_CPP__EVERY_THING_SAFETY_NODE_ACTIONS_HPP_

#include <string>

#include "every_thing_safety_cpp/every_thing_safety_node_actions_base.hpp"

namespace every_thing_safety_cpp
{

/// The actions of this robot that its safety rules call.
class EveryThingSafetyNodeActions : public EveryThingSafetyNodeActionsBase
{
public:
  using EveryThingSafetyNodeActionsBase::EveryThingSafetyNodeActionsBase;

  // Declare the actions here, and write them in every_thing_safety_node_actions.cpp. Until then the
  // node says at its start that they do nothing, and whenever they should have been carried out.
  //
  // void release() override;
  //
  // void beep(double times, const std::string & why) override;
};

}  // namespace every_thing_safety_cpp

#endif  // EVERY_THING_SAFETY_CPP__EVERY_THING_SAFETY_NODE_ACTIONS_HPP_
