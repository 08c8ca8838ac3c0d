"""The intermediate form of rules, which every target reads."""
