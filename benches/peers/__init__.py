"""What a user would write without Linkwright: each file answers one bench's question with another tool."""
