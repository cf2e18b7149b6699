"""Preview of a job while it is being written: its mistakes, and the values that its ranges allow."""
