"""The command line: reads options, calls one function of a lower room for each verb, prints the result."""
