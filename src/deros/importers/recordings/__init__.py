"""Models from recordings of rosbag2: topics, QoS and message definitions."""
