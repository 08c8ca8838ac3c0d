"""Files that people write into and imports renew: what is whose, and what differs."""
