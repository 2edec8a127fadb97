"""Command line and, later, service and pages: asks and shows, decides nothing."""
