"""What does an integral term in the joint controllers improve, and what does it cost?"""
