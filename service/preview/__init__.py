"""Preview of a job during editing: its mistakes, and the values that its ranges allow."""
