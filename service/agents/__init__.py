"""Tools for agents over the Model Context Protocol (MCP); their answers match those of the command line."""
