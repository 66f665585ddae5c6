"""Pictures of pirouette's run folders."""
