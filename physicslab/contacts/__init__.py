"""What is done with contacts: pairs listed, constraints made wide, sleepers woken, figures reported."""
