// Copyright and licence: see package.xml.

// The actions of two_rules_safety_node: yours to fill in.
// deros wrote this file once and leaves it alone.

#ifndef TWO_RULES_SAFETY_CPP__TWO_RULES_SAFETY_NODE_ACTIONS_HPP_
#define TWO_RULES_SAFETY_CPP__TWO_RULES_SAFETY_NODE_ACTIONS_HPP_

#include "two_rules_safety_cpp/two_rules_safety_node_actions_base.hpp"

namespace two_rules_safety_cpp
{

/// The actions of this robot that its safety rules call.
class TwoRulesSafetyNodeActions : public TwoRulesSafetyNodeActionsBase
{
public:
  using TwoRulesSafetyNodeActionsBase::TwoRulesSafetyNodeActionsBase;

  // Declare the actions here, and write them in two_rules_safety_node_actions.cpp. Until then the
  // node says at its start that they do nothing, and whenever they should have been carried out.
  //
  // void stop() override;
};

}  // namespace two_rules_safety_cpp

#endif  // TWO_RULES_SAFETY_CPP__TWO_RULES_SAFETY_NODE_ACTIONS_HPP_
