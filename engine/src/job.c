typedef int iso_job_to_come;
