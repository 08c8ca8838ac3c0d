"""What has changed between two versions of models, by meaning."""
