"""Tools for agents over the Model Context Protocol (MCP), with the answers of the command line."""
