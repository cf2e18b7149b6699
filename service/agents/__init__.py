"""What agents ask by the Model Context Protocol (MCP): a few tools over what the command line answers."""
