"""What can be said of a job while it is being written: what is wrong with it, and what its ranges allow."""
